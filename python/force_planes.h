#pragma once

#include <array>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/force_field.h"
#include "python/arrays.h"
#include "solve/result_planes.h"

namespace pillarfield::python {

/// The planes of frame after frame, in memory that arrays take over.
class ForceStack {
 public:
  explicit ForceStack(const Skin& skin)
      : layout_(skin.layout), rows_(skin.element_rows()), cols_(skin.element_cols()) {}

  /// Makes room for `frames` in all.
  void reserve(std::size_t frames);
  /// Copies a frame; needs no Python lock. Throws std::bad_alloc.
  void append(const ForceFieldView& forces);
  /// {"shear_x": [frames, rows, cols], ..., "uncertainty_phi_low": ..., "status": ...}, with the
  /// planes that the frames had. Leaves the stack empty.
  [[nodiscard]] py::dict release();

 private:
  struct Free {
    void operator()(std::byte* memory) const { std::free(memory); }
  };
  /// A plane of all frames; no memory: the frames lack it.
  struct Plane {
    std::unique_ptr<std::byte, Free> memory;
    std::size_t frame_bytes = 0;

    void resize(std::size_t frames);
  };

  void append(Plane& plane, std::span<const std::byte> frame);

  SkinLayout layout_;
  std::uint32_t rows_;
  std::uint32_t cols_;
  std::size_t frames_ = 0;
  std::size_t capacity_ = 0;
  std::array<Plane, kSolvedPlanes> planes_;
  Plane status_;
};

/// The planes of one frame as read-only arrays [rows, cols] over memory that `owner` keeps alive.
[[nodiscard]] py::dict lent_planes(const ForceFieldView& forces, const py::object& owner);

/// A copy of the planes of one frame.
class ForceCopy {
 public:
  explicit ForceCopy(const ForceFieldView& forces);
  [[nodiscard]] const ForceFieldView& view() const { return view_; }

 private:
  std::vector<float> values_;
  std::vector<std::uint8_t> status_;
  ForceFieldView view_;
};

/// Arrays of planes that came from Python: {"shear_x": float32 [frames, rows, cols], ...,
/// "status": uint8}.
class ForceArrays {
 public:
  /// Throws Error if normal force or status is missing, or one component of shear, or a plane has
  /// another type or shape or is not dense.
  explicit ForceArrays(const py::dict& planes);

  [[nodiscard]] std::size_t frames() const { return frames_; }
  [[nodiscard]] std::uint32_t rows() const { return rows_; }
  [[nodiscard]] std::uint32_t cols() const { return cols_; }
  /// Without shear there are no pillars.
  [[nodiscard]] SkinLayout layout() const {
    return planes_[0] == nullptr ? SkinLayout::sensels : SkinLayout::pillars;
  }
  [[nodiscard]] ForceFieldView frame(std::size_t index) const;

 private:
  template <class T>
  const T* data_of(const py::dict& planes, const std::string& name);

  std::vector<py::array> arrays_;
  std::array<const float*, kSolvedPlanes> planes_{};
  const std::uint8_t* status_ = nullptr;
  std::size_t frames_ = 0;
  std::uint32_t rows_ = 0;
  std::uint32_t cols_ = 0;
};

}  // namespace pillarfield::python
