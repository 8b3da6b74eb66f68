// What a plan may ask for, at a square metre, its whole skin loaded.

#include <fmt/format.h>

#include "bench/cases/rows.h"
#include "bench/timing/solve_race.h"

namespace pillarfield::bench {
namespace {

void add_plan_row(const Session& session, const std::string& name, const SolverPlan& plan,
                  const ProcessorTuning& tuning = {}) {
  add_row(name, [&session, plan, tuning] { return race_solve(session, plan, {}, {}, tuning); });
}

SolverPlan plan_with(std::string_view stage) {
  SolverPlan plan = bare_plan(kSquareMetre);
  add_stage(plan, stage);
  return plan;
}

}  // namespace

void add_plan_rows(const Session& session) {
  for (const auto& [name, type] :
       {std::pair{"u8", SenselType::u8}, {"u16", SenselType::u16}, {"f32", SenselType::f32}}) {
    add_plan_row(session, fmt::format("type/{}", name), bare_plan(kSquareMetre, type));
  }

  SolverPlan both = plan_with("angles");
  add_stage(both, "uncertainty");
  add_plan_row(session, "output/forces", plan_with("none"));
  add_plan_row(session, "output/angles", plan_with("angles"));
  add_plan_row(session, "output/uncertainty", plan_with("uncertainty"));
  add_plan_row(session, "output/all", both);
  add_stage(both, "half");
  add_plan_row(session, "output/half", plan_with("half"));
  add_plan_row(session, "output/all_half", both);

  for (const Estimator estimator : {Estimator::direct, Estimator::paper}) {
    SolverPlan plan = plan_with("none");
    plan.estimator = estimator;
    add_plan_row(session, fmt::format("estimator/{}", name_of(estimator)), plan);
  }
  for (const int lanes : {1, 2, 4, 8, 16}) {
    add_plan_row(session, fmt::format("lanes/{}", lanes), plan_with("none"), {.lanes = lanes});
  }
  // Planes of a square metre are made only when a row is asked for.
  for (const std::string_view stage : stage_names()) {
    add_row(fmt::format("stage/{}", stage),
            [&session, stage] { return race_solve(session, plan_with(stage)); });
  }
}

}  // namespace pillarfield::bench
