#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "pillarfield/force_field.h"
#include "pillarfield/status.h"

namespace pillarfield {

/// Errors of solved forces over the pillars of one true region.
struct RegionErrors {
  std::uint64_t pillars = 0;
  std::uint64_t status_mismatches =
      0;                     ///< pillars whose usable sensels differ from the ideal model's
  double rms_n = 0;          ///< RMS of |solved − true|, N
  double p95_n = 0;          ///< 95th percentile of |solved − true|, N
  double rms_relative = 0;   ///< RMS of |solved − true| / |true|; 0 in Region::none
  double p95_relative = 0;   ///< 95th percentile of |solved − true| / |true|
  double theta_rms_rad = 0;  ///< 0 in Region::none
  double phi_rms_rad = 0;    ///< weighted with sin(theta): phi is undefined at the normal
};

/// Compares solved forces with the truth over many frames. Percentiles come from a logarithmic
/// histogram, exact to 2 % from 1e-15 to 1e15; below they are 0, above infinite.
class Comparison {
 public:
  Comparison();
  ~Comparison();
  Comparison(Comparison&&) noexcept;
  Comparison& operator=(Comparison&&) noexcept;

  /// Adds a frame, of pillars or of sensels without shear, which have no regions but loaded and
  /// Region::none. The true region follows from the ideal model's readings; one of at most 1e-6 of
  /// its pillar's largest counts as zero. A solved NaN counts as an infinite error. Throws Error if
  /// sizes or layouts differ or the truth is not finite.
  void add(const ForceFieldView& solved, const ForceFieldView& truth);

  /// The errors in one true region.
  [[nodiscard]] RegionErrors region(Region region) const;

  /// The errors of all truly loaded pillars.
  [[nodiscard]] RegionErrors loaded() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
