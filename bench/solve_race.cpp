#include "bench/solve_race.h"

#include <fmt/format.h>

#include <array>

namespace pillarfield::bench {

CeilingEntry::CeilingEntry(Race& race, const Device& device, const SolverPlan& plan,
                           const Frames& frames, int frames_in_flight)
    : pillars_(static_cast<double>(plan.skin.pillars())),
      cached_(device, plan, frames, CopyStores::cached, frames_in_flight),
      streaming_(device, plan, frames, CopyStores::streaming, frames_in_flight),
      cached_entry_(race.add([this](int count) { cached_.run(count); })),
      streaming_entry_(race.add([this](int count) { streaming_.run(count); })) {}

std::size_t CeilingEntry::fastest(const Race& race) const {
  return race.fastest(std::array{cached_entry_, streaming_entry_});
}

void CeilingEntry::tell(const Race& race, Measurement& measured) const {
  measured.counters["copy_cached"] = race.median(cached_entry_) * 1e9 / pillars_;
  measured.counters["copy_streaming"] = race.median(streaming_entry_) * 1e9 / pillars_;
}

Measurement measurement_of(const Race& race, std::size_t contestant, const SolverPlan& plan) {
  const auto pillars = static_cast<double>(plan.skin.pillars());
  Measurement measured;
  measured.seconds = race.median(contestant);
  measured.counters["ns_per_pillar"] = measured.seconds * 1e9 / pillars;
  measured.counters["bytes_per_pillar"] = static_cast<double>(streams_of(plan).bytes_per_pillar());
  measured.counters["pillars"] = pillars;
  return measured;
}

Measurement race_solve(const Session& session, const SolverPlan& plan, const Scenery& scenery,
                       const Processor::Options& options) {
  const Frames frames(plan.skin, plan.sensel_type, scenery);
  FrameSolver solver(session.device, plan, frames, options);
  Race race;
  const std::size_t solve = race.add([&](int count) { solver.run(count); });
  CeilingEntry ceiling(race, session.device, plan, frames, options.frames_in_flight);
  race.run(session.length);
  Measurement measured = measurement_of(race, solve, plan);
  measured.counters["of_ceiling"] = race.ratio(ceiling.fastest(race), solve);
  ceiling.tell(race, measured);
  measured.label = fmt::format("{} frames", frames.size());
  return measured;
}

}  // namespace pillarfield::bench
