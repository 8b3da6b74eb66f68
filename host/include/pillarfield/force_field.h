#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pillarfield {

/// What is told of the uncertainty of a force (docs/derivations/uncertainty.md). The first three
/// are standard deviations, N: of the noise of the sensels, and in an ambiguous pillar also of what
/// its readings leave open. The others are the ends of what direction and magnitude may be,
/// noise apart: both the estimate itself where the pillar is not ambiguous. They hold for pillars
/// without missing and saturated sensels.
enum class Uncertainty : std::uint8_t {
  shear_x,         ///< N
  shear_y,         ///< N
  normal,          ///< N
  theta_low,       ///< rad
  theta_high,      ///< rad
  phi_low,         ///< rad; phi runs counter-clockwise from low to high, which is the smaller one
  phi_high,        ///< rad; where it passes pi
  magnitude_low,   ///< N
  magnitude_high,  ///< N
};
inline constexpr std::size_t kUncertaintyPlanes = 9;

/// "shear_x", "theta_low", ...: as in files.
[[nodiscard]] const char* name_of(Uncertainty plane);

/// One plane of each kind.
template <class Plane>
class UncertaintyPlanes {
 public:
  Plane& operator[](Uncertainty plane) { return planes_[static_cast<std::size_t>(plane)]; }
  const Plane& operator[](Uncertainty plane) const {
    return planes_[static_cast<std::size_t>(plane)];
  }
  [[nodiscard]] auto begin() { return planes_.begin(); }
  [[nodiscard]] auto end() { return planes_.end(); }
  [[nodiscard]] auto begin() const { return planes_.begin(); }
  [[nodiscard]] auto end() const { return planes_.end(); }

 private:
  std::array<Plane, kUncertaintyPlanes> planes_;
};

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
  UncertaintyPlanes<std::span<const float>> uncertainty;  ///< only where asked for
};

/// The same with memory of its own; used for truths and copies. Magnitude and angles are absent,
/// and the uncertainty mostly is.
struct ForceField {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<float> shear_x;
  std::vector<float> shear_y;
  std::vector<float> normal;
  std::vector<std::uint8_t> status;
  UncertaintyPlanes<std::vector<float>> uncertainty;  ///< empty where not known

  ForceField() = default;
  ForceField(std::uint32_t pillar_rows, std::uint32_t pillar_cols);

  [[nodiscard]] std::size_t pillars() const { return std::size_t{rows} * cols; }
  [[nodiscard]] ForceFieldView view() const;
};

}  // namespace pillarfield
