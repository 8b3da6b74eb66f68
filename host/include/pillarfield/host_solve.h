#pragma once

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Solves one frame in the calling thread, without OpenCL; link `pillarfield::core`.
///
///     ForceField forces = solve_on_host(plan, frame.view());
///
/// It computes what Processor computes on the device "host", bit for bit, by the vectors of the
/// processor; it is the simplest choice for single frames.
///
/// `frame` has the plan's size and type, with any row stride; the result is [pillar rows, pillar
/// cols] and owns its memory. The function has no state: the estimator `contact` treats each frame
/// separately (as with FrictionKnowledge::memory off), sensels with a memory are at rest before it,
/// and the tare stays. For sequences of frames take a Processor. `plan.angles` has no effect.
///
/// Throws Error if the plan is out of range or the frame does not fit it. Threads: any number at
/// once.
[[nodiscard]] ForceField solve_on_host(const SolverPlan& plan, const FrameView& frame);

}  // namespace pillarfield
