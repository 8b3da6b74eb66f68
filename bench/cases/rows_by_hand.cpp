// Our solve of skins of all sizes beside the loop that is vectorised by hand.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <thread>

#include "bench/baselines/agreement.h"
#include "bench/baselines/loop_solver.h"
#include "bench/baselines/vectorised.h"
#include "bench/cases/rows.h"
#include "bench/timing/solve_race.h"

namespace pillarfield::bench {
namespace {

/// 10^3 to 10^7 pillars, nearly.
constexpr std::uint32_t kSides[] = {32, 100, 316, 1000, 3162};

/// The row's time is that of the loop, the faster one of its two kinds.
Measurement race_by_hand(const Session& session, const SolverPlan& plan) {
  const Vectorised by_hand = vectorised().front();
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const Frames frames(plan.skin, plan.sensel_type, {});
  FrameSolver ours(session.device, plan, frames);
  LoopSolver cached(plan, by_hand.cached, threads);
  LoopSolver streaming(plan, by_hand.streaming, threads);
  require_same_bits("vectorised loop", cached.solve(frames[0]), ours.solve(frames[0]));
  Race race;
  const std::size_t our_entry = race.add([&](int count) { ours.run(count); });
  const std::array loops = {race.add([&](int count) { cached.run(frames, count); }),
                            race.add([&](int count) { streaming.run(frames, count); })};
  CeilingEntry ceiling(race, session.device, plan, frames, Processor::Options{}.frames_in_flight);
  race.run(session.length);
  const std::size_t theirs = race.fastest(loops);
  Measurement measured = measurement_of(race, theirs, plan);
  measured.counters["our_ns_per_pillar"] =
      race.median(our_entry) * 1e9 / static_cast<double>(plan.skin.pillars());
  measured.counters["speedup"] = race.ratio(theirs, our_entry);
  measured.counters["of_ceiling"] = race.ratio(ceiling.fastest(race), our_entry);
  ceiling.tell(race, measured);
  measured.label = fmt::format("{}, threads: {}", by_hand.instructions, threads);
  return measured;
}

}  // namespace

void add_by_hand_rows(const Session& session) {
  for (const std::uint32_t side : kSides) {
    const SolverPlan plan = bare_plan(side);
    add_row(fmt::format("by_hand/{}", plan.skin.pillars()),
            [&session, plan] { return race_by_hand(session, plan); });
  }
}

}  // namespace pillarfield::bench
