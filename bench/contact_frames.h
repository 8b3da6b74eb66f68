#pragma once

#include <cstddef>

#include "bench/frames.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// Motion of the indenters on a square metre.
enum class Indenters : std::uint8_t {
  mixed,     ///< press, slide, slip partially and spin, friction 0.5 to 1.1
  slipping,  ///< all slip, friction 1.7: a quarter of the pillars has two inactive sensels
};

/// uint8 frames of a simulated sensor with noise. Eight balls cover 5 % of a square metre and move
/// by less than their radius.
class ContactFrames {
 public:
  /// Simulates `count` frames in 50 ms each.
  ContactFrames(Indenters indenters, std::size_t count);

  /// The direct solve with the noise of the sensor.
  [[nodiscard]] const SolverPlan& plan() const { return plan_; }
  [[nodiscard]] const Frames& frames() const { return frames_; }

 private:
  SolverPlan plan_;
  Frames frames_;
};

}  // namespace pillarfield::bench
