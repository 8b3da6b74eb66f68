#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pillarfield/force_field.h"
#include "viewer/source/object_pool.h"
#include "viewer/source/shown_field.h"

namespace pillarfield::viewer {

/// The planes of a field in one zeroed block of whole pages, of pillars with angles; each plane
/// begins on a page, as in a Processor.
class PlaneBlock {
 public:
  /// Those of Uncertainty follow.
  enum Plane : std::size_t { kShearX, kShearY, kNormal, kMagnitude, kTheta, kPhi };
  static constexpr std::size_t kPlanes = kPhi + 1 + kUncertaintyPlanes;

  PlaneBlock(SkinLayout layout, std::uint32_t rows, std::uint32_t cols, bool uncertainty);

  /// Empty for a plane that fields of this layout do not have.
  [[nodiscard]] std::span<float> plane(std::size_t which) const;
  [[nodiscard]] std::span<std::uint8_t> status() const;

  /// Copies a field of this size and layout; computes magnitude and angles that it lacks. Its
  /// uncertainty is copied if both have it.
  void copy(const ForceFieldView& forces);

  [[nodiscard]] ForceFieldView view() const;
  [[nodiscard]] std::span<const std::byte> pages() const { return {pages_.get(), bytes_}; }

 private:
  struct Free {
    void operator()(std::byte* memory) const;
  };

  void set_directions(const ForceFieldView& forces);

  [[nodiscard]] std::size_t elements() const { return std::size_t{rows_} * cols_; }

  static constexpr std::size_t kAbsentPlane = ~std::size_t{0};

  std::uint32_t rows_;
  std::uint32_t cols_;
  std::array<std::size_t, kPlanes> places_{};  ///< in the block, counted in planes
  std::size_t planes_ = 0;                     ///< number of float planes
  std::size_t plane_bytes_;                    ///< distance between planes
  std::size_t bytes_;
  std::unique_ptr<std::byte[], Free> pages_;
};

}  // namespace pillarfield::viewer
