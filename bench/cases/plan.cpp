// The options of a plan, on a square metre that is loaded everywhere.

#include <fmt/format.h>

#include "bench/cases/cases.h"
#include "bench/timing/solve_timing.h"

namespace pillarfield::bench {
namespace {

void add_plan_case(const Session& session, const std::string& name, const SolverPlan& plan,
                   const ProcessorTuning& tuning = {}) {
  add_case(name, [&session, plan, tuning] { return time_solve(session, plan, {}, {}, tuning); });
}

SolverPlan plan_with(std::string_view stage) {
  SolverPlan plan = bare_plan(kSquareMetre);
  add_stage(plan, stage);
  return plan;
}

}  // namespace

void add_plan_cases(const Session& session) {
  for (const auto& [name, type] :
       {std::pair{"u8", SenselType::u8}, {"u16", SenselType::u16}, {"f32", SenselType::f32}}) {
    add_plan_case(session, fmt::format("type/{}", name), bare_plan(kSquareMetre, type));
  }

  SolverPlan both = plan_with("angles");
  add_stage(both, "uncertainty");
  add_plan_case(session, "output/forces", plan_with("none"));
  add_plan_case(session, "output/angles", plan_with("angles"));
  add_plan_case(session, "output/uncertainty", plan_with("uncertainty"));
  add_plan_case(session, "output/all", both);

  for (const Estimator estimator : {Estimator::direct, Estimator::paper}) {
    SolverPlan plan = plan_with("none");
    plan.estimator = estimator;
    add_plan_case(session, fmt::format("estimator/{}", name_of(estimator)), plan);
  }
  for (const int lanes : {1, 2, 4, 8, 16}) {
    add_plan_case(session, fmt::format("lanes/{}", lanes), plan_with("none"), {.lanes = lanes});
  }
  // The planes of a square metre are made only when the case runs.
  for (const std::string_view stage : stage_names()) {
    add_case(fmt::format("stage/{}", stage),
             [&session, stage] { return time_solve(session, plan_with(stage)); });
  }
  // Each effect of a real sensor on a calibrated skin, by fraction in contact.
  for (const double percent : {8.0, 100.0}) {
    for (const std::string_view effect : {"none", "curve", "shear_coefficient", "leak", "memory",
                                          "wires", "pillar_leak", "lean", "bending", "sensor"}) {
      add_case(fmt::format("sensor/{}/{}", percent, effect), [&session, percent, effect] {
        SolverPlan plan = plan_with("calibrated");
        add_stage(plan, effect);
        return time_solve(session, plan, {Touch::mixed, percent / 100});
      });
    }
  }
}

}  // namespace pillarfield::bench
