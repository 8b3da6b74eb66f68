#include "bench/timing/solve_race.h"

#include <fmt/format.h>

#include <utility>

namespace pillarfield::bench {

CeilingEntry::CeilingEntry(Race& race, const Device& device, const SolverPlan& plan,
                           const Frames& frames, int frames_in_flight)
    : pillars_(static_cast<double>(plan.skin.pillars())) {
  for (const CopyKind& kind : kCopyKinds) {
    auto kernel = std::make_unique<CopyKernel>(device, plan, frames, kind, frames_in_flight);
    const std::size_t number = race.add([copy = kernel.get()](int count) { copy->run(count); });
    entries_.push_back({fmt::format("copy_{}", kind.name), std::move(kernel), number});
    // Devices with a work-item for each pillar have one kind.
    if (device.info().lanes == 1) return;
  }
}

std::size_t CeilingEntry::fastest(const Race& race) const {
  std::vector<std::size_t> numbers;
  for (const Entry& entry : entries_) numbers.push_back(entry.number);
  return race.fastest(numbers);
}

void CeilingEntry::tell(const Race& race, Measurement& measured) const {
  for (const Entry& entry : entries_) {
    measured.counters[entry.name] = race.median(entry.number) * 1e9 / pillars_;
  }
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
                       const Processor::Options& options, const ProcessorTuning& tuning) {
  const Frames frames(plan.skin, plan.sensel_type, scenery);
  FrameSolver solver(session.device, plan, frames, options, tuning);
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
