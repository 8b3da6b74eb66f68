#pragma once

#include <cstddef>

#include "bench/noisy_frames.h"
#include "bench/solve_variant.h"
#include "pillarfield/processor.h"

namespace pillarfield::bench {

/// How wrong the forces of a variant are, beside the least that noise allows.
struct ForceError {
  /// RMS of |solved − true|, counts of a uint8 sensel, where the true force is in region 1 or 2 and
  /// every one of its sensels is whole, below full scale, and five standard deviations or more from
  /// the threshold.
  double counts = 0;
  /// RMS, over the same pillars, of |solved − true| over the Cramér–Rao bound of the pillar: of its
  /// sensels' noise as their calibration leaves it, a converter's rounding (1/12 count²) included.
  double over_bound = 0;
  std::size_t pillars = 0;  ///< of which there are so many
  double all_counts = 0;    ///< RMS of |solved − true| over all pillars, counts of a uint8 sensel
  double ambiguous = 0;     ///< share of all pillars whose status says so
};

/// Solves the first `count` of the frames, which are those of the variant's plan. The same on every
/// run. About 0.5 µs per pillar.
[[nodiscard]] ForceError measure_force_error(const Device& device, const SolveVariant& variant,
                                             const SolverPlan& plan, const NoisyFrames& frames,
                                             std::size_t count);

}  // namespace pillarfield::bench
