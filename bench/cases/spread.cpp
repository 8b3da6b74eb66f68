// Histogram of the times of single frames.

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>

#include "bench/cases/cases.h"
#include "bench/timing/solve_timing.h"

namespace pillarfield::bench {
namespace {

constexpr std::uint32_t kSide = 79;  ///< pillars: 10 x 10 cm
constexpr int kLeastTimes = 2000;
constexpr int kBinsPerDecade = 10;

/// Counters: the fraction of the times in each bin that is not empty, named by the bin's lower end
/// in microseconds: "solve_from_12.59us".
void report_spread(const InterleavedTiming& timing, std::size_t candidate, const std::string& name,
                   Measurement& measured) {
  const auto times = timing.times(candidate);
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

/// Frames one at a time, interleaved with empty launches.
Measurement time_single_frames(const Session& session, const SolverPlan& plan) {
  const Frames frames(plan.skin, plan.sensel_type, {});
  FrameSolver solver(session.device, plan, frames, {.frames_in_flight = 1});
  EmptyLaunch launch(session.device);
  InterleavedTiming timing;
  const std::size_t solve = timing.add([&](int count) { solver.run(count); });
  const std::size_t empty = timing.add([&](int count) { launch.run(count); });
  timing.run({session.length.seconds, kLeastTimes, 0, 1});
  Measurement measured = measurement_of(timing, solve, plan);
  report_spread(timing, solve, "solve", measured);
  report_spread(timing, empty, "empty", measured);
  measured.label = fmt::format("{} times", timing.times(solve).size());
  return measured;
}

}  // namespace

void add_spread_cases(const Session& session) {
  const SolverPlan plan = bare_plan(kSide);
  add_case(fmt::format("spread/{}", plan.skin.pillars()),
           [&session, plan] { return time_single_frames(session, plan); });
}

}  // namespace pillarfield::bench
