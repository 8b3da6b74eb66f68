#include "bench/timing/measurement.h"

#include <benchmark/benchmark.h>

#include <exception>
#include <memory>
#include <utility>

namespace pillarfield::bench {

namespace {

class Row final : public benchmark::internal::Benchmark {
 public:
  Row(const std::string& name, std::function<Measurement()> measure)
      : Benchmark(name.c_str()), measure_(std::move(measure)) {}

  void Run(benchmark::State& state) override {
    try {
      // A race has its own rounds: main() asks for no more than one iteration.
      for ([[maybe_unused]] auto iteration : state) tell(state, measure_());
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  }

 private:
  static void tell(benchmark::State& state, const Measurement& measured) {
    state.SetIterationTime(measured.seconds);
    for (const auto& [counter, value] : measured.counters) state.counters[counter] = value;
    state.SetLabel(measured.label);
  }

  std::function<Measurement()> measure_;
};

}  // namespace

void add_row(const std::string& name, std::function<Measurement()> measure) {
  auto row = std::make_unique<Row>(name, std::move(measure));
  row->UseManualTime()->Unit(benchmark::kMicrosecond);
  benchmark::internal::RegisterBenchmarkInternal(row.release());  // Which owns it from now on.
}

}  // namespace pillarfield::bench
