#pragma once

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// What the kernel computes, as a plain C++ loop over the same mathematics in single precision: the
/// same bits, save for what goes through functions of a library: the power law, and all of the
/// paper's estimator. It is the measure that devices are tested against. The planes of
/// `plan.angles` are not made.
///
/// `frame` is of the plan's size and type; the result is [pillar rows, pillar cols].
ForceField solve_on_host(const SolverPlan& plan, const FrameView& frame);

/// Lets `plan.calibration.tare` follow a frame that was just solved into `forces`, as the device
/// does where `plan.baseline_rate` is set. The tare must be there. `index` counts the frames from
/// zero and tells which pillar rows have their turn.
void follow_baseline_on_host(SolverPlan& plan, const FrameView& frame, const ForceField& forces,
                             std::uint64_t index = 0);

}  // namespace pillarfield
