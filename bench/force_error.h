#pragma once

#include <cstddef>

#include "bench/noisy_frames.h"
#include "bench/solve_variant.h"
#include "pillarfield/processor.h"

namespace pillarfield::bench {

/// Error of a variant's forces, absolute and relative to the Cramér–Rao bound.
struct ForceError {
  /// RMS of |solved − true|, counts of a uint8 sensel, over pillars whose true force is in region 1
  /// or 2 and whose sensels are all intact, below full scale, and at least five standard deviations
  /// from the threshold.
  double counts = 0;
  /// RMS, over these pillars, of |solved − true| over the pillar's Cramér–Rao bound, for the noise
  /// of calibrated readings with the converter's rounding (1/12 count²).
  double over_bound = 0;
  std::size_t pillars = 0;  ///< number of these pillars
  double all_counts = 0;    ///< RMS of |solved − true| over all pillars, counts of a uint8 sensel
  double ambiguous = 0;     ///< fraction of all pillars with an ambiguous status
};

/// Solves the first `count` frames, which must be of the variant's plan. Deterministic. About
/// 0.5 µs per pillar.
[[nodiscard]] ForceError measure_force_error(const Device& device, const SolveVariant& variant,
                                             const SolverPlan& plan, const NoisyFrames& frames,
                                             std::size_t count);

}  // namespace pillarfield::bench
