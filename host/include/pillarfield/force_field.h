#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pillarfield {

/// A field of three-axis force, row by row from the top left, one value per pillar and plane.
///
/// Forces are in newtons: shear_x (+ right) and shear_y (+ up) are the tangential force that acts
/// on the skin, normal is positive when the skin is pressed. Status bytes: see status.h.
/// Planes that were not asked for are empty.
struct ForceFieldView {
  std::uint32_t rows = 0;  ///< pillar rows
  std::uint32_t cols = 0;  ///< pillar columns
  std::span<const float> shear_x;
  std::span<const float> shear_y;
  std::span<const float> normal;
  std::span<const std::uint8_t> status;
  std::span<const float> magnitude;  ///< N, only where angles were asked for
  std::span<const float> theta;      ///< rad from the outward normal, [0, pi]; as magnitude
  std::span<const float> phi;        ///< rad in the plane, (-pi, pi]; as magnitude
};

/// The same with memory of its own; used for truths and copies. Magnitude and angles are absent.
struct ForceField {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<float> shear_x;
  std::vector<float> shear_y;
  std::vector<float> normal;
  std::vector<std::uint8_t> status;

  ForceField() = default;
  ForceField(std::uint32_t pillar_rows, std::uint32_t pillar_cols);

  [[nodiscard]] std::size_t pillars() const { return std::size_t{rows} * cols; }
  [[nodiscard]] ForceFieldView view() const;
};

}  // namespace pillarfield
