#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/frames.h"
#include "pillarfield/solver_plan.h"
#include "solve/pillar_maths.h"

namespace pillarfield::bench {

/// Frames of a sensor with noise under known forces: 15 to 150 counts of a uint8 sensel on each
/// pillar, log-uniform, with directions uniform over the hemisphere.
///
/// A sensel reads raw = t + g·max(0, V − z) with the tare t, gain 1/g and dead zone z of the plan's
/// calibration, and normal noise of kSensorNoiseCounts; a masked sensel reads 0. uint8 and uint16
/// sensels round to whole counts, at least 0. Seeds are fixed.
class NoisyFrames {
 public:
  /// `count` frames of the skin and type of `plan`. About 20 ns per sensel.
  NoisyFrames(const SolverPlan& plan, std::size_t count);

  [[nodiscard]] const Frames& frames() const { return frames_; }

  /// The true force on a pillar, N.
  [[nodiscard]] double_precision::Force truth(std::size_t frame, std::uint32_t row,
                                              std::uint32_t col) const;

 private:
  Frames frames_;
  double counts_per_newton_;
  double count_scale_;
};

}  // namespace pillarfield::bench
