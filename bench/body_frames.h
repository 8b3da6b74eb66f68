#pragma once

#include <cstddef>

#include "bench/frames.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// What bodies do on a square metre.
enum class Bodies : std::uint8_t {
  mixed,     ///< press, slide, partly slip and spin, at frictions of 0.5 to 1.1
  slipping,  ///< all slip at a friction of 1.7: a quarter of the pillars has two inactive sensels
};

/// Frames of a simulated sensor, uint8 and with noise, on which eight balls cover 5 % of a square
/// metre and move by less than their radius.
class BodyFrames {
 public:
  /// So many frames; 50 ms each.
  BodyFrames(Bodies bodies, std::size_t count);

  /// The direct solve, the sensor's noise being known.
  [[nodiscard]] const SolverPlan& plan() const { return plan_; }
  [[nodiscard]] const Frames& frames() const { return frames_; }

 private:
  SolverPlan plan_;
  Frames frames_;
};

}  // namespace pillarfield::bench
