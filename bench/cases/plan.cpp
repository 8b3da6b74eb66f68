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
  add_plan_case(session, "type/u16", bare_plan(kSquareMetre, SenselType::u16));
  add_plan_case(session, "type/f32", bare_plan(kSquareMetre, SenselType::f32));
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
