// Other solvers of the same frames. A baseline is timed only where its result agrees with ours.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/baselines/agreement.h"
#include "bench/baselines/loop_solver.h"
#include "bench/baselines/vectorised.h"
#include "bench/cases/cases.h"
#include "bench/frames.h"
#include "bench/timing/solve_timing.h"
#include "bench/timing/unsuffixed_reporter.h"
#include "pillarfield/child_program.h"
#include "pillarfield/error.h"
#include "pillarfield/force_field.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {
namespace {

/// The bare direct solve in NumPy (solve.py) in a child process, which reads the number of frames
/// to solve from a pipe. The frames and its first result pass through files.
class NumpyProcess {
 public:
  /// Throws an Error that begins with kSkipped where no Python has NumPy.
  NumpyProcess(const SolverPlan& plan, const Frames& frames);
  ~NumpyProcess();
  NumpyProcess(const NumpyProcess&) = delete;
  NumpyProcess& operator=(const NumpyProcess&) = delete;

  /// Solves `frames` frames; returns the nanoseconds per pillar that the child measured.
  double run(int frames);

  /// Result of the first frame.
  [[nodiscard]] const ForceField& first_result() const { return first_; }

 private:
  bool starts(const char* python, const SolverPlan& plan);

  std::filesystem::path folder_;
  ForceField first_;
  std::optional<ChildProgram> child_;
};

constexpr std::size_t kMostFrames = 16;

std::filesystem::path make_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "pillarfield-bench-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw Error(name, "cannot be created", "check TMPDIR");
  return name;
}

void write_frames(const std::filesystem::path& path, const Frames& frames) {
  std::ofstream file(path, std::ios::binary);
  for (std::size_t i = 0; i < std::min(frames.size(), kMostFrames); ++i) {
    const FrameView frame = frames[i];
    file.write(static_cast<const char*>(frame.data),
               static_cast<std::streamsize>(std::size_t{frame.rows} * frame.cols));
  }
  file.close();
  if (!file) throw Error(path.string(), "cannot be written", "check the disk");
}

ForceField read_result(const std::filesystem::path& path, const Skin& skin) {
  ForceField field(skin.pillar_rows(), skin.pillar_cols());
  std::ifstream file(path, std::ios::binary);
  const auto read = [&](auto& plane) {
    file.read(reinterpret_cast<char*>(plane.data()),
              static_cast<std::streamsize>(plane.size() * sizeof(plane[0])));
  };
  read(field.shear_x);
  read(field.shear_y);
  read(field.normal);
  read(field.status);
  if (!file) throw Error(path.string(), "NumPy's result is too short");
  return field;
}

NumpyProcess::NumpyProcess(const SolverPlan& plan, const Frames& frames) : folder_(make_folder()) {
  write_frames(folder_ / "frames", frames);
  // The system's Python may have NumPy where the first one on the path does not.
  for (const char* const python : {"/usr/bin/python3", "python3"}) {
    if (!starts(python, plan)) continue;
    first_ = read_result(folder_ / "result", plan.skin);
    return;
  }
  std::filesystem::remove_all(folder_);
  throw Error("", fmt::format("{}no Python with NumPy was found", kSkipped),
              "install the Debian package python3-numpy");
}

NumpyProcess::~NumpyProcess() {
  child_.reset();
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

double NumpyProcess::run(int frames) {
  const bool fed = child_->feed(fmt::format("{}\n", frames));
  const std::string answer = fed ? child_->read_line() : "";
  if (answer.empty()) throw Error("NumPy", "the process ended", "run bench/baselines/solve.py");
  return std::stod(answer);
}

bool NumpyProcess::starts(const char* python, const SolverPlan& plan) {
  try {
    child_.emplace(
        std::vector<std::string>{
            python, PILLARFIELD_NUMPY_SOLVE, (folder_ / "frames").string(),
            fmt::format("{}", plan.skin.rows), fmt::format("{}", plan.skin.cols),
            fmt::format("{}", plan.skin.threshold_counts),
            fmt::format("{}", plan.skin.counts_per_newton), (folder_ / "result").string()},
        "", ChildProgram::kPipe);
  } catch (const Error&) {
    return false;
  }
  return child_->read_line() == "ready";
}

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
