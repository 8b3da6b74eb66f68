#pragma once

#include <array>
#include <cstdint>

#include "pillarfield/force_field.h"
#include "pillarfield/status.h"

namespace pillarfield {

/// How often the stated uncertainty holds the truth, over the pillars solved in one region.
struct RegionCoverage {
  std::uint64_t pillars = 0;
  double shear_x = 0;  ///< share with the true component within 1.96 standard deviations; 0.95 due
  double shear_y = 0;
  double normal = 0;
  double ends = 0;  ///< share with true theta, phi and magnitude between the ends; see Coverage
};

/// Accumulates the coverage of frames. Regions are those of the status, for a user has no other.
/// Pillars with a missing or saturated sensel, or readings at odds, are left out: of them nothing
/// is claimed.
///
/// The ends are stated noise apart. They are therefore widened by three standard deviations of the
/// force's vector: sigma for the magnitude, sigma / magnitude for theta, and that over sin(theta)
/// for phi.
class Coverage {
 public:
  /// Adds one frame; `solved` with its uncertainty, both of the same size. Throws Error where
  /// planes are absent or sizes differ.
  void add(const ForceFieldView& solved, const ForceFieldView& truth);

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
