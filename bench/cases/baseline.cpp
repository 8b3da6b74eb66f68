// The paper's equations beside our solve of the same frames.

#include "bench/cases/cases.h"
#include "bench/timing/solve_timing.h"

namespace pillarfield::bench {
namespace {

/// The case's time is that of the paper's equations, one pillar per work-item.
Measurement time_paper(const Session& session) {
  const SolverPlan plan = bare_plan(kSquareMetre);
  SolverPlan paper_plan = plan;
  paper_plan.estimator = Estimator::paper;
  const Frames frames(plan.skin, plan.sensel_type, {});
  FrameSolver ours(session.solver, plan, frames);
  FrameSolver paper(session.device, paper_plan, frames, {}, {.lanes = 1});
  InterleavedTiming timing;
  const std::size_t our_entry = timing.add([&](int count) { ours.run(count); });
  const std::size_t paper_entry = timing.add([&](int count) { paper.run(count); });
  CopyEntries copies(timing, session.device, plan, frames, Processor::Options{}.frames_in_flight);
  timing.run(session.length);
  Measurement measured = measurement_of(timing, paper_entry, plan);
  measured.counters["our_ns_per_pillar"] =
      timing.median(our_entry) * 1e9 / static_cast<double>(plan.skin.pillars());
  measured.counters["speedup"] = timing.ratio(paper_entry, our_entry);
  measured.counters["of_copy"] = timing.ratio(copies.fastest(timing), paper_entry);
  copies.report(timing, measured);
  measured.label = "one pillar per work-item";
  return measured;
}

}  // namespace

void add_baseline_cases(const Session& session) {
  add_case("baseline/paper_opencl", [&session] { return time_paper(session); });
}

}  // namespace pillarfield::bench
