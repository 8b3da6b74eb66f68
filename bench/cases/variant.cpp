// Every solve variant, on frames of a sensor with noise under known forces.

#include <fmt/format.h>

#include <memory>

#include "bench/cases/cases.h"
#include "bench/force_error.h"
#include "bench/noisy_frame_store.h"
#include "bench/solve_variant.h"
#include "bench/timing/solve_timing.h"
#include "bench/variant_solver.h"

namespace pillarfield::bench {
namespace {

constexpr std::size_t kFrames = 32;  ///< 80 MB of uint8 sensels: more than caches hold

void report(const ForceError& error, Measurement& measured) {
  measured.counters["error_counts"] = error.counts;
  measured.counters["error_over_bound"] = error.over_bound;
  measured.counters["error_pillars"] = static_cast<double>(error.pillars);
  measured.counters["error_counts_all_regions"] = error.all_counts;
  measured.counters["ambiguous"] = error.ambiguous;
}

/// `over_bare_copy` is the time over that of the copy of the bare uint8 solve, 17 bytes per pillar.
Measurement time_variant(const Session& session, const SolveVariant& variant,
                         NoisyFrameStore& store) {
  const SolverPlan plan = plan_of(variant, kSquareMetre);
  const SolverPlan bare = plan_of(SolveVariant{}, kSquareMetre);
  const NoisyFrames& noisy = store.of(plan);
  const Frames& frames = noisy.frames();
  const int in_flight = Processor::Options{}.frames_in_flight;
  VariantSolver solver(session.device, variant, plan, frames);
  InterleavedTiming timing;
  const std::size_t solve = timing.add([&](int count) { solver.run(count); });
  CopyEntries copies(timing, session.device, plan, frames, in_flight);
  CopyEntries bare_copy(timing, session.device, bare, store.bare().frames(), in_flight);
  timing.run(session.length);
  Measurement measured = measurement_of(timing, solve, plan);
  measured.counters["of_copy"] = timing.ratio(copies.fastest(timing), solve);
  measured.counters["over_bare_copy"] = timing.ratio(solve, bare_copy.fastest(timing));
  copies.report(timing, measured);
  report(measure_force_error(session.device, variant, plan, noisy, 1), measured);
  measured.label = fmt::format("{} frames", frames.size());
  return measured;
}

}  // namespace

void add_variant_cases(const Session& session) {
  const auto store = std::make_shared<NoisyFrameStore>(kSquareMetre, kFrames);
  for (const SolveVariant& variant : solve_variants()) {
    add_case(fmt::format("variant/{}", name_of(variant)),
             [&session, variant, store] { return time_variant(session, variant, *store); });
  }
}

}  // namespace pillarfield::bench
