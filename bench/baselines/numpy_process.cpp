#include "bench/baselines/numpy_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "bench/timing/plain_names.h"
#include "pillarfield/error.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to us.

namespace pillarfield::bench {
namespace {

constexpr std::size_t kMostFrames = 16;

std::filesystem::path make_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "pillarfield-bench-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw Error(name, "cannot be made", "check TMPDIR");
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
  if (!file) throw Error(path.string(), "the result of NumPy is too short");
  return field;
}

/// Starts a program whose standard input and output are `socket`; -1 where there is none.
pid_t spawn(std::vector<std::string> words, int socket) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, socket, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, socket, STDOUT_FILENO);
  // That there is no NumPy is told in a line of ours.
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  const int failed =
      posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed == 0 ? child : -1;
}

}  // namespace

NumpyProcess::NumpyProcess(const SolverPlan& plan, const Frames& frames) : folder_(make_folder()) {
  write_frames(folder_ / "frames", frames);
  // The system's Python may have NumPy where the first on the path has not.
  for (const char* const python : {"/usr/bin/python3", "python3"}) {
    start(python, plan);
    if (read_line() != "ready") continue;
    first_ = read_result(folder_ / "result", plan.skin);
    return;
  }
  std::filesystem::remove_all(folder_);
  throw Error("", fmt::format("{}no Python with NumPy was found", kSkipped),
              "install the Debian package python3-numpy");
}

NumpyProcess::~NumpyProcess() {
  close(socket_);
  waitpid(child_, nullptr, 0);
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

double NumpyProcess::run(int frames) {
  const std::string line = fmt::format("{}\n", frames);
  send(socket_, line.data(), line.size(), MSG_NOSIGNAL);
  const std::string answer = read_line();
  if (answer.empty()) throw Error("NumPy", "the process ended", "run bench/baselines/solve.py");
  return std::stod(answer);
}

void NumpyProcess::start(const char* python, const SolverPlan& plan) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw Error("NumPy", "no socket can be made", "close some programs");
  }
  if (socket_ >= 0) close(socket_);
  if (child_ >= 0) waitpid(child_, nullptr, 0);
  socket_ = ends[0];
  child_ = spawn({python, PILLARFIELD_NUMPY_SOLVE, (folder_ / "frames").string(),
                  fmt::format("{}", plan.skin.rows), fmt::format("{}", plan.skin.cols),
                  fmt::format("{}", plan.skin.threshold_counts),
                  fmt::format("{}", plan.skin.counts_per_newton), (folder_ / "result").string()},
                 ends[1]);
  close(ends[1]);
}

std::string NumpyProcess::read_line() const {
  std::string line;
  char character = 0;
  while (recv(socket_, &character, 1, 0) == 1 && character != '\n') line += character;
  return line;
}

}  // namespace pillarfield::bench
