#include "contacts/estimator/contact_estimator.h"
#include "lanes/lane_solver.h"
#include "pillarfield/host_solve.h"

namespace pillarfield {

ForceField solve_on_host(const SolverPlan& plan, const FrameView& frame) {
  check(plan, "solve_on_host");
  check(frame, plan.skin, plan.sensel_type, "solve_on_host");
  ForceField field = solve_in_lanes(plan, frame);
  if (estimator_of(plan) == Estimator::contact) ContactEstimator(plan).resolve(field);
  return field;
}

}  // namespace pillarfield
