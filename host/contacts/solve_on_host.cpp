#include "contacts/estimator/contact_estimator.h"
#include "pillarfield/host_solve.h"
#include "solve/pillar_solve.h"

namespace pillarfield {

ForceField solve_on_host(const SolverPlan& plan, const FrameView& frame) {
  SensorState at_rest;
  return solve_on_host(plan, frame, at_rest);
}

ForceField solve_on_host(const SolverPlan& plan, const FrameView& frame, SensorState& state) {
  check(plan, "solve_on_host");
  check(frame, plan.skin, plan.sensel_type, "solve_on_host");
  ForceField field = solve_pillars(plan, frame, state);
  if (plan.estimator == Estimator::contact) ContactEstimator(plan).resolve(field);
  return field;
}

}  // namespace pillarfield
