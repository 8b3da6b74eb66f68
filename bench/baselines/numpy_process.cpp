#include "bench/baselines/numpy_process.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "bench/timing/unsuffixed_reporter.h"
#include "pillarfield/error.h"

namespace pillarfield::bench {
namespace {

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

}  // namespace

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

}  // namespace pillarfield::bench
