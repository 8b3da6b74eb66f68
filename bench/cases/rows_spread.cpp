// How the times of single frames are spread.

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>

#include "bench/cases/rows.h"
#include "bench/timing/solve_race.h"

namespace pillarfield::bench {
namespace {

constexpr std::uint32_t kSide = 79;  ///< pillars: 10 x 10 cm
constexpr int kLeastTimes = 2000;
constexpr int kBinsPerDecade = 10;

/// The share of the times in each bin that holds one, by the bin's lower end in microseconds:
/// "solve_from_12.59us".
void tell_spread(const Race& race, std::size_t contestant, const std::string& name,
                 Measurement& measured) {
  const auto times = race.times(contestant);
  std::map<int, int> counts;
  for (const double seconds : times) {
    ++counts[static_cast<int>(std::floor(kBinsPerDecade * std::log10(seconds * 1e6)))];
  }
  for (const auto& [bin, count] : counts) {
    const double from_us = std::pow(10, static_cast<double>(bin) / kBinsPerDecade);
    measured.counters[fmt::format("{}_from_{:.4g}us", name, from_us)] =
        static_cast<double>(count) / static_cast<double>(times.size());
  }
}

/// Frames one at a time, and a kernel that does nothing in between.
Measurement race_single_frames(const Session& session, const SolverPlan& plan) {
  const Frames frames(plan.skin, plan.sensel_type, {});
  FrameSolver solver(session.device, plan, frames, {.frames_in_flight = 1});
  EmptyLaunch launch(session.device);
  Race race;
  const std::size_t solve = race.add([&](int count) { solver.run(count); });
  const std::size_t empty = race.add([&](int count) { launch.run(count); });
  race.run({session.length.seconds, kLeastTimes, 0, 1});
  Measurement measured = measurement_of(race, solve, plan);
  tell_spread(race, solve, "solve", measured);
  tell_spread(race, empty, "empty", measured);
  measured.label = fmt::format("{} times", race.times(solve).size());
  return measured;
}

}  // namespace

void add_spread_rows(const Session& session) {
  const SolverPlan plan = bare_plan(kSide);
  add_row(fmt::format("spread/{}", plan.skin.pillars()),
          [&session, plan] { return race_single_frames(session, plan); });
}

}  // namespace pillarfield::bench
