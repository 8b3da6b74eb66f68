// The solve of skins of all sizes beside the loop of vector intrinsics.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <thread>

#include "bench/baselines/agreement.h"
#include "bench/baselines/loop_solver.h"
#include "bench/baselines/vectorised.h"
#include "bench/cases/cases.h"
#include "bench/timing/solve_timing.h"

namespace pillarfield::bench {
namespace {

/// Square roots of about 10^3 to 10^7 pillars.
constexpr std::uint32_t kIntrinsicSides[] = {32, 100, 316, 1000, 3162};

/// The case's time is that of the faster of the two loops.
Measurement time_intrinsics(const Session& session, const SolverPlan& plan) {
  const Vectorised intrinsics = vectorised().front();
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const Frames frames(plan.skin, plan.sensel_type, {});
  FrameSolver ours(session.solver, plan, frames);
  LoopSolver cached(plan, intrinsics.cached, threads);
  LoopSolver streaming(plan, intrinsics.streaming, threads);
  require_same_bits("vectorised loop", cached.solve(frames[0]), ours.solve(frames[0]));
  InterleavedTiming timing;
  const std::size_t our_entry = timing.add([&](int count) { ours.run(count); });
  const std::array loops = {timing.add([&](int count) { cached.run(frames, count); }),
                            timing.add([&](int count) { streaming.run(frames, count); })};
  CopyEntries copies(timing, session.device, plan, frames, Processor::Options{}.frames_in_flight);
  timing.run(session.length);
  const std::size_t theirs = timing.fastest(loops);
  Measurement measured = measurement_of(timing, theirs, plan);
  measured.counters["our_ns_per_pillar"] =
      timing.median(our_entry) * 1e9 / static_cast<double>(plan.skin.pillars());
  measured.counters["speedup"] = timing.ratio(theirs, our_entry);
  measured.counters["of_copy"] = timing.ratio(copies.fastest(timing), our_entry);
  copies.report(timing, measured);
  measured.label =
      fmt::format("{}, threads: {}, ours on {}", intrinsics.instructions, threads, ours.device());
  return measured;
}

}  // namespace

void add_intrinsics_cases(const Session& session) {
  for (const std::uint32_t side : kIntrinsicSides) {
    const SolverPlan plan = bare_plan(side);
    add_case(fmt::format("intrinsics/{}", plan.skin.pillars()),
             [&session, plan] { return time_intrinsics(session, plan); });
  }
}

}  // namespace pillarfield::bench
