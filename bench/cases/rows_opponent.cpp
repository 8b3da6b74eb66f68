// Others who solve the same frames, each held to our result before its time is taken.

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
#include "bench/baselines/plain_loop.h"
#include "bench/baselines/vectorised.h"
#include "bench/cases/rows.h"
#include "bench/timing/plain_names.h"
#include "bench/timing/solve_race.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"

namespace pillarfield::bench {
namespace {

constexpr std::size_t kFramesCompared = 2;
constexpr float kNumpyTolerance = 1e-6F;
/// The paper's estimator goes through functions of a library, which the device has its own of.
constexpr float kPaperTolerance = 64 * 1.2e-7F;

int all_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

/// A race of our own solve of a square metre and the copies of its streams with an opponent.
class Match {
 public:
  explicit Match(const Session& session)
      : session_(&session),
        plan_(bare_plan(kSquareMetre)),
        frames_(plan_.skin, plan_.sensel_type, {}),
        ours_(session.device, plan_, frames_),
        our_entry_(race_.add([this](int count) { ours_.run(count); })),
        ceiling_(race_, session.device, plan_, frames_, Processor::Options{}.frames_in_flight) {}

  [[nodiscard]] const SolverPlan& plan() const { return plan_; }
  [[nodiscard]] const Frames& frames() const { return frames_; }
  FrameSolver& ours() { return ours_; }

  void add(const std::string& label, Work work) { labels_[race_.add(std::move(work))] = label; }

  /// The opponent is the fastest of those added.
  Measurement run() {
    race_.run(session_->length);
    std::vector<std::size_t> entries;
    for (const auto& [entry, label] : labels_) entries.push_back(entry);
    const std::size_t theirs = race_.fastest(entries);
    Measurement measured = measurement_of(race_, theirs, plan_);
    measured.counters["our_ns_per_pillar"] =
        race_.median(our_entry_) * 1e9 / static_cast<double>(plan_.skin.pillars());
    measured.counters["speedup"] = race_.ratio(theirs, our_entry_);
    measured.counters["of_ceiling"] = race_.ratio(ceiling_.fastest(race_), theirs);
    ceiling_.tell(race_, measured);
    measured.label = labels_.at(theirs);
    return measured;
  }

 private:
  const Session* session_;
  SolverPlan plan_;
  Frames frames_;
  FrameSolver ours_;
  Race race_;
  std::size_t our_entry_;
  CeilingEntry ceiling_;
  std::map<std::size_t, std::string> labels_;  ///< of the opponents
};

void hold_to_ours(const char* name, LoopSolver& theirs, Match& match) {
  for (std::size_t i = 0; i < kFramesCompared; ++i) {
    require_same_bits(name, theirs.solve(match.frames()[i]), match.ours().solve(match.frames()[i]));
  }
}

Measurement race_plain_loop(const Session& session, int threads) {
  Match match(session);
  LoopSolver loop(match.plan(), solve_rows_plainly, threads);
  hold_to_ours("C++ loop", loop, match);
  match.add(fmt::format("-O3, threads: {}", threads),
            [&](int count) { loop.run(match.frames(), count); });
  return match.run();
}

Measurement race_vectorised(const Session& session) {
  const Vectorised by_hand = vectorised();
  if (by_hand.instructions == nullptr) {
    throw Error("", fmt::format("{}this processor has no AVX2", kSkipped));
  }
  Match match(session);
  require_whole_threshold(bare_solve(match.plan()));
  LoopSolver cached(match.plan(), by_hand.cached, all_threads());
  LoopSolver streaming(match.plan(), by_hand.streaming, all_threads());
  hold_to_ours("vectorised loop", cached, match);
  hold_to_ours("vectorised loop, streaming", streaming, match);
  const std::string label = fmt::format("{}, threads: {}", by_hand.instructions, all_threads());
  match.add(label, [&](int count) { cached.run(match.frames(), count); });
  match.add(label + ", streaming", [&](int count) { streaming.run(match.frames(), count); });
  return match.run();
}

Measurement race_paper(const Session& session) {
  Match match(session);
  SolverPlan plan = match.plan();
  plan.estimator = Estimator::paper;
  FrameSolver paper(session.device, plan, match.frames(), {}, {.lanes = 1});
  require_near("the paper's equations", paper.solve(match.frames()[0]),
               solve_on_host(plan, match.frames()[0]).view(), kPaperTolerance);
  match.add("one pillar per work-item", [&](int count) { paper.run(count); });
  return match.run();
}

Measurement race_numpy(const Session& session) {
  Match match(session);
  NumpyProcess numpy(match.plan(), match.frames());
  require_near("NumPy", numpy.first_result().view(), match.ours().solve(match.frames()[0]),
               kNumpyTolerance);
  double nanoseconds = 0;
  match.add("float32 arrays", [&](int count) { nanoseconds = numpy.run(count); });
  Measurement measured = match.run();
  measured.counters["last_by_its_own_clock"] = nanoseconds;
  return measured;
}

}  // namespace

void add_opponent_rows(const Session& session) {
  add_row("opponent/paper_opencl", [&session] { return race_paper(session); });
  add_row("opponent/cpp_one_thread", [&session] { return race_plain_loop(session, 1); });
  add_row("opponent/cpp_all_threads",
          [&session] { return race_plain_loop(session, all_threads()); });
  add_row("opponent/vectorised", [&session] { return race_vectorised(session); });
  add_row("opponent/numpy", [&session] { return race_numpy(session); });
}

}  // namespace pillarfield::bench
