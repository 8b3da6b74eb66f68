#include "bench/measurement.h"

#include <benchmark/benchmark.h>

#include <exception>
#include <utility>

namespace pillarfield::bench {

void add_row(const std::string& name, std::function<Measurement()> measure) {
  const auto run = [measure = std::move(measure)](benchmark::State& state) {
    try {
      // A race has its own rounds: main() asks for no more than one iteration.
      for ([[maybe_unused]] auto iteration : state) {
        const Measurement measured = measure();
        state.SetIterationTime(measured.seconds);
        for (const auto& [counter, value] : measured.counters) state.counters[counter] = value;
        state.SetLabel(measured.label);
      }
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  };
  benchmark::RegisterBenchmark(name.c_str(), run)->UseManualTime()->Unit(benchmark::kMicrosecond);
}

}  // namespace pillarfield::bench
