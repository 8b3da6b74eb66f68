// What no solve can be faster than.

#include <fmt/format.h>

#include <cstring>

#include "bench/cases/rows.h"
#include "bench/timing/solve_race.h"

namespace pillarfield::bench {
namespace {

Measurement race_copies(const Session& session, const SolverPlan& plan) {
  const Frames frames(plan.skin, plan.sensel_type, {});
  Race race;
  CeilingEntry ceiling(race, session.device, plan, frames, Processor::Options{}.frames_in_flight);
  race.run(session.length);
  const std::size_t fastest = ceiling.fastest(race);
  Measurement measured = measurement_of(race, fastest, plan);
  ceiling.tell(race, measured);
  measured.counters["GB_per_s"] =
      measured.counters["bytes_per_pillar"] / measured.counters["ns_per_pillar"];
  measured.label = fmt::format("{} frames", frames.size());
  return measured;
}

Measurement time_empty_launch(const Session& session) {
  EmptyLaunch launch(session.device);
  Race race;
  const std::size_t empty = race.add([&](int count) { launch.run(count); });
  race.run(session.length);
  return {race.median(empty), {{"p99_us", race.quantile(empty, 0.99) * 1e6}}, "start and wait"};
}

/// One thread, the frames of a square metre, each to the same place.
Measurement time_memcpy(const Session& session) {
  const SolverPlan plan = bare_plan(kSquareMetre);
  const Frames frames(plan.skin, plan.sensel_type, {});
  FrameBuffer to(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  Race race;
  std::size_t next = 0;
  const std::size_t copy = race.add([&](int count) {
    for (int i = 0; i < count; ++i) {
      std::memcpy(to.bytes().data(), frames[next++].data, to.bytes().size());
    }
  });
  race.run(session.length);
  const double bytes = 2 * static_cast<double>(to.bytes().size());
  return {race.median(copy), {{"GB_per_s", bytes * 1e-9 / race.median(copy)}}, "read and written"};
}

}  // namespace

void add_ceiling_rows(const Session& session) {
  for (const std::uint32_t side : {100U, kSquareMetre, 1000U}) {
    const SolverPlan plan = bare_plan(side);
    add_row(fmt::format("ceiling/copy/{}/none", plan.skin.pillars()),
            [&session, plan] { return race_copies(session, plan); });
  }
  for (const char* const stage : {"mask", "tare", "baseline", "angles", "uncertainty", "all"}) {
    add_row(fmt::format("ceiling/copy/{}/{}", bare_plan(kSquareMetre).skin.pillars(), stage),
            [&session, stage] {
              SolverPlan plan = bare_plan(kSquareMetre);
              add_stage(plan, stage);
              return race_copies(session, plan);
            });
  }
  add_row("ceiling/empty_launch", [&session] { return time_empty_launch(session); });
  add_row("ceiling/memcpy", [&session] { return time_memcpy(session); });
}

}  // namespace pillarfield::bench
