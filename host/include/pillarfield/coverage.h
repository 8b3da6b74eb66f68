#pragma once

#include <array>
#include <cstdint>

#include "pillarfield/force_field.h"
#include "pillarfield/status.h"

namespace pillarfield {

/// Fractions of the pillars of one region whose true values lie in the stated intervals.
struct RegionCoverage {
  std::uint64_t pillars = 0;
  double shear_x = 0;  ///< fraction within 1.96 standard deviations; ideal: 0.95
  double shear_y = 0;
  double normal = 0;
  double ends = 0;  ///< fraction with theta, phi and magnitude all within bounds; see Coverage
};

/// Measures the coverage of the stated uncertainty over many frames. Regions are those of the
/// solved status. Pillars with missing, saturated or inconsistent readings are left out, since
/// their uncertainty is not stated.
///
/// The bounds of theta, phi and magnitude exclude noise. They are therefore widened by three
/// standard deviations of the force vector: sigma for the magnitude, sigma / magnitude for theta,
/// and that over sin(theta) for phi.
class Coverage {
 public:
  /// Adds a frame. Throws Error if `solved` has no uncertainty or sizes differ.
  void add(const ForceFieldView& solved, const ForceFieldView& truth);

  /// The coverage in one region.
  [[nodiscard]] RegionCoverage region(Region region) const;

 private:
  struct Counts {
    std::uint64_t pillars = 0;
    std::array<std::uint64_t, 3> within{};
    std::uint64_t between_ends = 0;
  };
  std::array<Counts, kRegions> counts_{};
};

}  // namespace pillarfield
