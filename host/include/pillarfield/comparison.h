#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "pillarfield/force_field.h"
#include "pillarfield/status.h"

namespace pillarfield {

/// Errors of solved forces against the truth, over the pillars of one true region.
struct RegionErrors {
  std::uint64_t pillars = 0;
  std::uint64_t status_mismatches = 0;  ///< usable readings are not those of the ideal model
  double rms_n = 0;                     ///< RMS of |solved − true|
  double p95_n = 0;                     ///< 95 % of the pillars have at most this |solved − true|
  double rms_relative = 0;              ///< RMS of |solved − true| / |true|; 0 in region `none`
  double p95_relative = 0;
  double theta_rms_rad = 0;  ///< 0 in region `none`
  double phi_rms_rad = 0;    ///< weighted with sin(theta), for phi means little near the normal
};

/// Accumulates the comparison of frames. The 95 % figures come from a logarithmic histogram and
/// are exact to 2 % between 1e-15 and 1e15, below which they are 0 and beyond which infinite.
/// Nothing is lost by it: single precision rounds a force of 1e-8 N, a millionth of a count where a
/// newton gives 100, by as little as 1e-15 N.
class Comparison {
 public:
  Comparison();
  ~Comparison();
  Comparison(Comparison&&) noexcept;
  Comparison& operator=(Comparison&&) noexcept;

  /// Adds one frame; both of the same size. The region is that of the ideal model's readings, where
  /// one of at most 1e-6 of its pillar's largest is zero. A solved force that is not a number is an
  /// infinite error. Throws Error where sizes differ or the truth holds what is not a number.
  void add(const ForceFieldView& solved, const ForceFieldView& truth);

  /// Of one true region.
  [[nodiscard]] RegionErrors region(Region region) const;

  /// Of all pillars that the truth loads.
  [[nodiscard]] RegionErrors loaded() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
