#pragma once

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Solves each pillar by itself with the estimator `direct` or `paper`; for `contact`, returns the
/// direct forces from which that one starts. Plan and frame must be valid and fit each other.
[[nodiscard]] ForceField solve_pillars(const SolverPlan& plan, const FrameView& frame);

}  // namespace pillarfield
