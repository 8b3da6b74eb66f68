#pragma once

#include <array>
#include <cstddef>
#include <cstdlib>
#include <memory>

#include "python/arrays.h"
#include "solve/result_planes.h"

namespace pillarfield::python {

/// The planes of frame after frame, in memory that arrays take over.
class ForceStack {
 public:
  ForceStack(std::uint32_t rows, std::uint32_t cols) : rows_(rows), cols_(cols) {}

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

  std::uint32_t rows_;
  std::uint32_t cols_;
  std::size_t frames_ = 0;
  std::size_t capacity_ = 0;
  std::array<Plane, kSolvedPlanes> planes_;
  Plane status_;
};

/// The planes of one frame as arrays [rows, cols] over memory that `owner` keeps alive.
[[nodiscard]] py::dict lent_planes(const ForceFieldView& forces, const py::object& owner);

}  // namespace pillarfield::python
