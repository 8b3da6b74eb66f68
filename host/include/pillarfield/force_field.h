#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/skin.h"

namespace pillarfield {

/// Deviation, or bound of a magnitude, that the readings of an element do not bound, N.
inline constexpr float kOpenN = 1e38F;

/// Planes that state the uncertainty of a force (docs/derivations/uncertainty.md). The first three
/// are standard deviations: from sensel noise and, in ambiguous pillars, from the segment that the
/// readings allow. The others bound direction and magnitude over that segment, without noise; in
/// other pillars both bounds equal the estimate. What saturated sensels leave open has the
/// deviation or bound kOpenN. All are valid for pillars without missing sensels.
enum class Uncertainty : std::uint8_t {
  shear_x,         ///< N
  shear_y,         ///< N
  normal,          ///< N
  theta_low,       ///< rad
  theta_high,      ///< rad
  phi_low,         ///< rad; phi runs counter-clockwise from low to high;
  phi_high,        ///< rad; high is below low if the interval contains pi
  magnitude_low,   ///< N
  magnitude_high,  ///< N
};
inline constexpr std::size_t kUncertaintyPlanes = 9;

/// "shear_x", "theta_low", ...: as in files.
[[nodiscard]] const char* name_of(Uncertainty plane);

/// One plane of each kind of Uncertainty.
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

/// A view of a field of three-axis force: planes [rows, cols], one value per element (pillar, or
/// sensel of a skin without pillars), row by row from the top left.
///
/// shear_x (+ right) and shear_y (+ up) are the tangential force on the skin; normal is positive
/// under pressure. The status byte is described in status.h. Planes that the plan does not enable
/// are empty; without pillars also shear_x and shear_y, and of the uncertainty all but that of
/// normal.
struct ForceFieldView {
  std::uint32_t rows = 0;  ///< of elements
  std::uint32_t cols = 0;
  std::span<const float> shear_x;  ///< N
  std::span<const float> shear_y;  ///< N
  std::span<const float> normal;   ///< N
  std::span<const std::uint8_t> status;
  std::span<const float> magnitude;  ///< N; with SolverPlan::angles
  std::span<const float> theta;      ///< rad from the outward normal, [0, pi]
  std::span<const float> phi;        ///< rad in the plane of the skin, (-pi, pi]
  UncertaintyPlanes<std::span<const float>> uncertainty;  ///< with SolverPlan::uncertainty
};

/// A field of force that owns its memory, without magnitude and angles: the result of
/// solve_on_host(), truths, copies. See ForceFieldView for shapes, units and signs.
struct ForceField {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<float> shear_x;
  std::vector<float> shear_y;
  std::vector<float> normal;
  std::vector<std::uint8_t> status;
  UncertaintyPlanes<std::vector<float>> uncertainty;  ///< empty if not computed

  ForceField() = default;
  /// All forces and status bytes zero, no uncertainty.
  ForceField(std::uint32_t pillar_rows, std::uint32_t pillar_cols);
  /// The same for the elements of a skin; without pillars there is no shear.
  explicit ForceField(const Skin& skin);
  /// A copy.
  explicit ForceField(const ForceFieldView& field);

  [[nodiscard]] std::size_t elements() const { return std::size_t{rows} * cols; }
  [[nodiscard]] ForceFieldView view() const;
};

}  // namespace pillarfield
