// How long one frame takes, and how many a second there are.

#include <fmt/format.h>

#include "bench/cases/rows.h"
#include "bench/timing/solve_race.h"

namespace pillarfield::bench {
namespace {

/// A patch of 32 x 32 pillars, 10 x 10 cm, and a square metre.
constexpr std::uint32_t kLatencySides[] = {32, 79, kSquareMetre};

/// From submit to result, one frame at a time, beside an empty launch.
Measurement race_latency(const Session& session, const SolverPlan& plan) {
  const Frames frames(plan.skin, plan.sensel_type, {});
  FrameSolver solver(session.device, plan, frames, {.frames_in_flight = 1});
  EmptyLaunch launch(session.device);
  Race race;
  const std::size_t solve = race.add([&](int count) { solver.run(count); });
  const std::size_t empty = race.add([&](int count) { launch.run(count); });
  // Turns of one frame each: the times are those of single frames.
  race.run({session.length.seconds, 20 * session.length.rounds, 0, 1});
  Measurement measured = measurement_of(race, solve, plan);
  measured.counters["median_us"] = race.median(solve) * 1e6;
  measured.counters["p99_us"] = race.quantile(solve, 0.99) * 1e6;
  measured.counters["of_empty_launch"] = race.ratio(solve, empty);
  measured.label = fmt::format("{} times", race.times(solve).size());
  return measured;
}

void add_throughput_row(const Session& session, const char* name, Memory memory, int in_flight) {
  add_row(fmt::format("throughput/{}/{}", name, in_flight), [&session, memory, in_flight] {
    Measurement measured = race_solve(session, bare_plan(kSquareMetre), {},
                                      {.memory = memory, .frames_in_flight = in_flight});
    measured.counters["frames_per_s"] = 1 / measured.seconds;
    return measured;
  });
}

}  // namespace

void add_time_rows(const Session& session) {
  for (const std::uint32_t side : kLatencySides) {
    const SolverPlan plan = bare_plan(side);
    add_row(fmt::format("latency/{}", plan.skin.pillars()),
            [&session, plan] { return race_latency(session, plan); });
  }
  for (const int in_flight : {1, 2, 3}) {
    add_throughput_row(session, "shared", Memory::shared, in_flight);
    add_throughput_row(session, "staged", Memory::staged, in_flight);
  }
}

}  // namespace pillarfield::bench
