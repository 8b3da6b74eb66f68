#pragma once

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Solves each pillar by itself with the estimator `direct` or `paper`; for `contact`, returns the
/// direct forces from which that one starts. `state` is that of the sensels, which is updated. Plan
/// and frame must be valid and fit each other.
[[nodiscard]] ForceField solve_pillars(const SolverPlan& plan, const FrameView& frame,
                                       SensorState& state);

}  // namespace pillarfield
