// References for the solve: copies, memcpy, an empty launch, and the paper's equations.

#include <fmt/format.h>

#include <cstring>

#include "bench/cases/cases.h"
#include "bench/timing/solve_timing.h"

namespace pillarfield::bench {
namespace {

Measurement time_copies(const Session& session, const SolverPlan& plan) {
  const Frames frames(plan.skin, plan.sensel_type, {});
  InterleavedTiming timing;
  CopyEntries copies(timing, session.device, plan, frames, Processor::Options{}.frames_in_flight);
  timing.run(session.length);
  const std::size_t fastest = copies.fastest(timing);
  Measurement measured = measurement_of(timing, fastest, plan);
  copies.report(timing, measured);
  measured.counters["GB_per_s"] =
      measured.counters["bytes_per_pillar"] / measured.counters["ns_per_pillar"];
  measured.label = fmt::format("{} frames", frames.size());
  return measured;
}

Measurement time_empty_launch(const Session& session) {
  EmptyLaunch launch(session.device);
  InterleavedTiming timing;
  const std::size_t empty = timing.add([&](int count) { launch.run(count); });
  timing.run(session.length);
  return {timing.median(empty), {{"p99_us", timing.quantile(empty, 0.99) * 1e6}}, "start and wait"};
}

/// One thread copies the frames of a square metre, each to one buffer.
Measurement time_memcpy(const Session& session) {
  const SolverPlan plan = bare_plan(kSquareMetre);
  const Frames frames(plan.skin, plan.sensel_type, {});
  FrameBuffer to(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  InterleavedTiming timing;
  std::size_t next = 0;
  const std::size_t copy = timing.add([&](int count) {
    for (int i = 0; i < count; ++i) {
      std::memcpy(to.bytes().data(), frames[next++].data, to.bytes().size());
    }
  });
  timing.run(session.length);
  const double bytes = 2 * static_cast<double>(to.bytes().size());
  return {
      timing.median(copy), {{"GB_per_s", bytes * 1e-9 / timing.median(copy)}}, "read and written"};
}

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

void add_limit_cases(const Session& session) {
  for (const std::uint32_t side : {100U, kSquareMetre, 1000U}) {
    const SolverPlan plan = bare_plan(side);
    add_case(fmt::format("limit/copy/{}", plan.skin.pillars()),
             [&session, plan] { return time_copies(session, plan); });
  }
  add_case("limit/empty_launch", [&session] { return time_empty_launch(session); });
  add_case("limit/memcpy", [&session] { return time_memcpy(session); });
}

void add_baseline_cases(const Session& session) {
  add_case("baseline/paper_opencl", [&session] { return time_paper(session); });
}

}  // namespace pillarfield::bench
