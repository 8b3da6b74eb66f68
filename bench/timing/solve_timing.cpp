#include "bench/timing/solve_timing.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <exception>
#include <memory>
#include <utility>

namespace pillarfield::bench {
namespace {

class Case final : public benchmark::internal::Benchmark {
 public:
  Case(const std::string& name, std::function<Measurement()> measure)
      : Benchmark(name.c_str()), measure_(std::move(measure)) {}

  void Run(benchmark::State& state) override {
    try {
      // InterleavedTiming has its own rounds: main() requests one iteration.
      for ([[maybe_unused]] auto iteration : state) report(state, measure_());
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  }

 private:
  static void report(benchmark::State& state, const Measurement& measured) {
    state.SetIterationTime(measured.seconds);
    for (const auto& [counter, value] : measured.counters) state.counters[counter] = value;
    state.SetLabel(measured.label);
  }

  std::function<Measurement()> measure_;
};

}  // namespace

void add_case(const std::string& name, std::function<Measurement()> measure) {
  auto added = std::make_unique<Case>(name, std::move(measure));
  added->UseManualTime()->Unit(benchmark::kMicrosecond);
  benchmark::internal::RegisterBenchmarkInternal(added.release());  // Takes ownership.
}

CopyEntries::CopyEntries(InterleavedTiming& timing, const Device& device, const SolverPlan& plan,
                         const Frames& frames, int frames_in_flight)
    : pillars_(static_cast<double>(plan.skin.pillars())) {
  for (const CopyKind& kind : kCopyKinds) {
    auto kernel = std::make_unique<CopyKernel>(device, plan, frames, kind, frames_in_flight);
    const std::size_t candidate =
        timing.add([copy = kernel.get()](int count) { copy->run(count); });
    entries_.push_back({fmt::format("copy_{}", kind.name), std::move(kernel), candidate});
    // A device with a work-item for each pillar has one kind.
    if (device.info().lanes == 1) return;
  }
}

std::size_t CopyEntries::fastest(const InterleavedTiming& timing) const {
  std::vector<std::size_t> candidates;
  for (const Entry& entry : entries_) candidates.push_back(entry.candidate);
  return timing.fastest(candidates);
}

void CopyEntries::report(const InterleavedTiming& timing, Measurement& measured) const {
  for (const Entry& entry : entries_) {
    measured.counters[entry.name] = timing.median(entry.candidate) * 1e9 / pillars_;
  }
}

Measurement measurement_of(const InterleavedTiming& timing, std::size_t candidate,
                           const SolverPlan& plan) {
  const auto pillars = static_cast<double>(plan.skin.pillars());
  Measurement measured;
  measured.seconds = timing.median(candidate);
  measured.counters["ns_per_pillar"] = measured.seconds * 1e9 / pillars;
  measured.counters["bytes_per_pillar"] = static_cast<double>(streams_of(plan).bytes_per_pillar());
  measured.counters["pillars"] = pillars;
  return measured;
}

Measurement time_solve(const Session& session, const SolverPlan& plan, const Scenario& scenario,
                       const Processor::Options& options, const ProcessorTuning& tuning) {
  const Frames frames(plan.skin, plan.sensel_type, scenario);
  FrameSolver solver(session.solver, plan, frames, options, tuning);
  InterleavedTiming timing;
  const std::size_t solve = timing.add([&](int count) { solver.run(count); });
  CopyEntries copies(timing, session.device, plan, frames, options.frames_in_flight);
  timing.run(session.length);
  Measurement measured = measurement_of(timing, solve, plan);
  measured.counters["of_copy"] = timing.ratio(copies.fastest(timing), solve);
  copies.report(timing, measured);
  measured.label = fmt::format("{} frames, {}", frames.size(), solver.device());
  return measured;
}

}  // namespace pillarfield::bench
