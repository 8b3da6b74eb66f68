#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/frames.h"
#include "pillarfield/solver_plan.h"
#include "solve/pillar_maths.h"

namespace pillarfield::bench {

/// Frames of a sensor with noise, every pillar of which is pressed with a force that is known: 15
/// to 150 counts of a uint8 sensel, as many weak as strong ones, from all directions of the
/// hemisphere alike.
///
/// A sensel reads raw = t + g·max(0, V − z) with the tare, gain 1/g and dead zone of the plan's
/// calibration, nothing where its mask says so, and normal noise of kSensorNoiseCounts; uint8 and
/// uint16 sensels round to whole counts and read no less than 0. Seeds are fixed.
class NoisyFrames {
 public:
  /// So many frames of the skin and type of `plan`. About 20 ns per sensel.
  NoisyFrames(const SolverPlan& plan, std::size_t count);

  [[nodiscard]] const Frames& frames() const { return frames_; }

  /// What presses a pillar, N.
  [[nodiscard]] double_precision::Force truth(std::size_t frame, std::uint32_t row,
                                              std::uint32_t col) const;

 private:
  Frames frames_;
  double counts_per_newton_;  ///< of the plan
  double count_scale_;        ///< of its type
};

}  // namespace pillarfield::bench
