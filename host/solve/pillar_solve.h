#pragma once

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// The part of solve_on_host() that treats each pillar by itself: the estimator `direct` or
/// `paper`, and where the plan says `contact`, the direct forces from which that one starts. Plan
/// and frame are valid and fit each other.
[[nodiscard]] ForceField solve_pillars(const SolverPlan& plan, const FrameView& frame);

}  // namespace pillarfield
