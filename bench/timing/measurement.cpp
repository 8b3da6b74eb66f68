#include "bench/timing/measurement.h"

#include <benchmark/benchmark.h>

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

}  // namespace pillarfield::bench
