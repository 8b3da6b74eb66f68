// Other solvers of the same frames. A baseline is timed only where its result agrees with ours.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/baselines/agreement.h"
#include "bench/baselines/loop_solver.h"
#include "bench/baselines/numpy_process.h"
#include "bench/baselines/vectorised.h"
#include "bench/cases/cases.h"
#include "bench/timing/solve_timing.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"

namespace pillarfield::bench {
namespace {

constexpr std::size_t kFramesCompared = 2;
constexpr float kNumpyTolerance = 1e-6F;
/// The paper's estimator uses library functions, which differ between device and host.
constexpr float kPaperTolerance = 64 * 1.2e-7F;

int all_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

/// Interleaved timing of our solve of a square metre, the copies of its streams and a baseline.
class Comparison {
 public:
  explicit Comparison(const Session& session)
      : session_(&session),
        plan_(bare_plan(kSquareMetre)),
        frames_(plan_.skin, plan_.sensel_type, {}),
        ours_(session.solver, plan_, frames_),
        our_entry_(timing_.add([this](int count) { ours_.run(count); })),
        copies_(timing_, session.device, plan_, frames_, Processor::Options{}.frames_in_flight) {}

  [[nodiscard]] const SolverPlan& plan() const { return plan_; }
  [[nodiscard]] const Frames& frames() const { return frames_; }
  FrameSolver& ours() { return ours_; }

  void add(const std::string& label, Work work) { labels_[timing_.add(std::move(work))] = label; }

  /// Reports the fastest of the baselines added.
  Measurement run() {
    timing_.run(session_->length);
    std::vector<std::size_t> entries;
    for (const auto& [entry, label] : labels_) entries.push_back(entry);
    const std::size_t theirs = timing_.fastest(entries);
    Measurement measured = measurement_of(timing_, theirs, plan_);
    measured.counters["our_ns_per_pillar"] =
        timing_.median(our_entry_) * 1e9 / static_cast<double>(plan_.skin.pillars());
    measured.counters["speedup"] = timing_.ratio(theirs, our_entry_);
    measured.counters["of_copy"] = timing_.ratio(copies_.fastest(timing_), theirs);
    copies_.report(timing_, measured);
    measured.label = labels_.at(theirs);
    return measured;
  }

 private:
  const Session* session_;
  SolverPlan plan_;
  Frames frames_;
  FrameSolver ours_;
  InterleavedTiming timing_;
  std::size_t our_entry_;
  CopyEntries copies_;
  std::map<std::size_t, std::string> labels_;  ///< of the baselines
};

void require_our_bits(const char* name, LoopSolver& theirs, Comparison& comparison) {
  for (std::size_t i = 0; i < kFramesCompared; ++i) {
    require_same_bits(name, theirs.solve(comparison.frames()[i]),
                      comparison.ours().solve(comparison.frames()[i]));
  }
}

Measurement time_vectorised(const Session& session) {
  const Vectorised intrinsics = vectorised().front();
  Comparison comparison(session);
  require_whole_threshold(bare_solve(comparison.plan()));
  LoopSolver cached(comparison.plan(), intrinsics.cached, all_threads());
  LoopSolver streaming(comparison.plan(), intrinsics.streaming, all_threads());
  require_our_bits("vectorised loop", cached, comparison);
  require_our_bits("vectorised loop, streaming", streaming, comparison);
  const std::string label = fmt::format("{}, threads: {}", intrinsics.instructions, all_threads());
  comparison.add(label, [&](int count) { cached.run(comparison.frames(), count); });
  comparison.add(label + ", streaming",
                 [&](int count) { streaming.run(comparison.frames(), count); });
  return comparison.run();
}

Measurement time_paper(const Session& session) {
  Comparison comparison(session);
  SolverPlan plan = comparison.plan();
  plan.estimator = Estimator::paper;
  FrameSolver paper(session.device, plan, comparison.frames(), {}, {.lanes = 1});
  require_near("the paper's equations", paper.solve(comparison.frames()[0]),
               solve_on_host(plan, comparison.frames()[0]).view(), kPaperTolerance);
  comparison.add("one pillar per work-item", [&](int count) { paper.run(count); });
  return comparison.run();
}

Measurement time_numpy(const Session& session) {
  Comparison comparison(session);
  NumpyProcess numpy(comparison.plan(), comparison.frames());
  require_near("NumPy", numpy.first_result().view(),
               comparison.ours().solve(comparison.frames()[0]), kNumpyTolerance);
  double nanoseconds = 0;
  comparison.add("float32 arrays", [&](int count) { nanoseconds = numpy.run(count); });
  Measurement measured = comparison.run();
  measured.counters["last_by_its_own_clock"] = nanoseconds;
  return measured;
}

}  // namespace

void add_baseline_cases(const Session& session) {
  add_case("baseline/paper_opencl", [&session] { return time_paper(session); });
  add_case("baseline/vectorised", [&session] { return time_vectorised(session); });
  add_case("baseline/numpy", [&session] { return time_numpy(session); });
}

}  // namespace pillarfield::bench
