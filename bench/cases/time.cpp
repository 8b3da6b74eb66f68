// Latency of a frame, and frames per second.

#include <fmt/format.h>

#include "bench/cases/cases.h"
#include "bench/timing/solve_timing.h"

namespace pillarfield::bench {
namespace {

/// A patch of 32 x 32 pillars, 10 x 10 cm, and a square metre.
constexpr std::uint32_t kLatencySides[] = {32, 79, kSquareMetre};

/// From submit to result, one frame at a time, interleaved with empty launches.
Measurement time_latency(const Session& session, const SolverPlan& plan) {
  const Frames frames(plan.skin, plan.sensel_type, {});
  FrameSolver solver(session.solver, plan, frames, {.frames_in_flight = 1});
  EmptyLaunch launch(session.device);
  InterleavedTiming timing;
  const std::size_t solve = timing.add([&](int count) { solver.run(count); });
  const std::size_t empty = timing.add([&](int count) { launch.run(count); });
  // Turns have one frame each: quantiles are of single frames.
  timing.run({session.length.seconds, 20 * session.length.rounds, 0, 1});
  Measurement measured = measurement_of(timing, solve, plan);
  measured.counters["median_us"] = timing.median(solve) * 1e6;
  measured.counters["p99_us"] = timing.quantile(solve, 0.99) * 1e6;
  measured.counters["of_empty_launch"] = timing.ratio(solve, empty);
  measured.label = fmt::format("{} times", timing.times(solve).size());
  return measured;
}

void add_throughput_case(const Session& session, const char* name, Memory memory, int in_flight) {
  add_case(fmt::format("throughput/{}/{}", name, in_flight), [&session, memory, in_flight] {
    Measurement measured = time_solve(session, bare_plan(kSquareMetre), {},
                                      {.memory = memory, .frames_in_flight = in_flight});
    measured.counters["frames_per_s"] = 1 / measured.seconds;
    return measured;
  });
}

}  // namespace

void add_time_cases(const Session& session) {
  for (const std::uint32_t side : kLatencySides) {
    const SolverPlan plan = bare_plan(side);
    add_case(fmt::format("latency/{}", plan.skin.pillars()),
             [&session, plan] { return time_latency(session, plan); });
  }
  for (const int in_flight : {1, 2, 3}) {
    add_throughput_case(session, "shared", Memory::shared, in_flight);
    add_throughput_case(session, "staged", Memory::staged, in_flight);
  }
}

}  // namespace pillarfield::bench
