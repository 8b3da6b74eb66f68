#include "bench/baselines/bare_solve.h"

#include "pillarfield/error.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"

namespace pillarfield::bench {

BareSolve bare_solve(const SolverPlan& plan) {
  if (!plan.skin.has_pillars() || plan.sensel_type != SenselType::u8 ||
      plan.estimator != Estimator::direct || !plan.calibration.empty() ||
      plan.skin.full_scale_counts || plan.skin.power_law || plan.parity_tolerance_counts ||
      plan.baseline_rate || plan.angles || plan.uncertainty ||
      plan.segment_point != kSegmentPoint) {
    throw Error("baseline", "the plan is not the bare direct solve of uint8 frames",
                "use a plan without stages");
  }
  const ForceScale scale = force_scale(plan.skin.counts_per_newton);
  return {static_cast<float>(plan.skin.threshold_counts), static_cast<float>(region_margin(plan)),
          static_cast<float>(scale.shear), static_cast<float>(scale.normal)};
}

}  // namespace pillarfield::bench
