// Reads every file of a corpus with its target, each in a separate process.
//
//     fuzz_replay CORPUS [FILE...]
//
// CORPUS has a folder for each target; FILE, as FOLDER/NAME, limits the run to these files. A file
// fails if its process ends by a signal, takes more than 5 s of processor time (20 s with
// sanitizers), a minute of wall time or 1 GiB (without sanitizers), or ends in anything but a
// pillarfield::Error. A file "seed_*" also fails if it is refused, any other if it is read. Exit
// status: 0, or 1 if a file fails.

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "fuzz/targets.h"
#include "pillarfield/error.h"

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
#else
constexpr bool kSanitized = false;
#endif

namespace pillarfield::fuzz {
namespace {

constexpr unsigned kMaxSeconds = kSanitized ? 20 : 5;  ///< processor time
constexpr unsigned kMaxWait = 60;                      ///< wall time, seconds
constexpr rlim_t kMaxBytes = 1 << 30;

// Exit statuses of a child that no sanitizer uses.
constexpr int kRead = 10;
constexpr int kRefused = 11;
constexpr int kOtherException = 12;
/// Exit status of a process that the HDF5 library crashes (hdf5/crash_guard.h).
constexpr int kCrashOfHdf5 = 1;
/// Exit status if HDF5 damages memory before AddressSanitizer's eyes (PillarfieldTesting.cmake).
constexpr int kSanitizer = 99;

void limit(decltype(RLIMIT_AS) resource, rlim_t most) {
  const rlimit both = {most, most};
  setrlimit(resource, &both);
}

/// Runs in the child; writes its message to the pipe `message`.
int read_under_limits(const Target& target, const std::filesystem::path& path, int message) {
  const auto report = [&](const char* text) {
    if (write(message, text, std::strlen(text)) < 0) _exit(kOtherException);
  };
  limit(RLIMIT_CORE, 0);
  if (!kSanitized) limit(RLIMIT_AS, kMaxBytes);
  alarm(kMaxWait);
  try {
    target.read(path, {.trust = false});
    return kRead;
  } catch (const Error& error) {
    report(error.what());
    return kRefused;
  } catch (const std::exception& error) {
    report(error.what());
    return kOtherException;
  }
}

struct Outcome {
  bool failed = false;
  bool refused = false;
  std::string text;
};

double seconds_of(const rusage& used) {
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// `used`: resources of the child and its own children.
Outcome outcome_of(int status, const rusage& used, const std::string& name,
                   const std::string& message) {
  const bool is_seed = name.starts_with("seed_");
  // Files on which HDF5 crashes, of its own code.
  const bool breaks_hdf5 = name.starts_with("sig") || name.starts_with("hang_");
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGALRM) return {true, false, fmt::format("takes over {} s", kMaxWait)};
    return {true, false, fmt::format("killed by signal {}, {}", signal, strsignal(signal))};
  }
  if (seconds_of(used) > kMaxSeconds) {
    return {true, false, fmt::format("takes {:.1f} s of processor time", seconds_of(used))};
  }
  switch (WEXITSTATUS(status)) {
    case kRead:
      return {!is_seed, false, is_seed ? "read" : "read, and should be refused"};
    case kRefused:
      return {is_seed, true, "refused: " + message};
    case kCrashOfHdf5:
      return {is_seed, true, "refused: HDF5 crashes or loops"};
    case kOtherException:
      return {true, false, "ends in an exception other than Error: " + message};
    case kSanitizer:
      if (breaks_hdf5) return {false, true, "refused: HDF5 damages memory"};
      [[fallthrough]];
    default:
      return {true, false, fmt::format("ends with exit status {}", WEXITSTATUS(status))};
  }
}

std::string all_of(int pipe_end) {
  std::string text;
  std::array<char, 4096> part{};
  ssize_t size = 0;
  while ((size = read(pipe_end, part.data(), part.size())) > 0) {
    text.append(part.data(), static_cast<std::size_t>(size));
  }
  close(pipe_end);
  return text;
}

Outcome replay(const Target& target, const std::filesystem::path& path) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Error(path.string(), "cannot create a pipe", "close some programs");
  const pid_t child = fork();
  if (child < 0) throw Error(path.string(), "cannot create a process", "close some programs");
  if (child == 0) {
    close(ends[0]);
    _exit(read_under_limits(target, path, ends[1]));
  }
  close(ends[1]);
  const std::string message = all_of(ends[0]);
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  return outcome_of(status, used, path.filename().string(), message);
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

const Target* target_named(const std::string& name) {
  const auto* const found = std::find_if(kTargets.begin(), kTargets.end(),
                                         [&](const Target& target) { return target.name == name; });
  return found == kTargets.end() ? nullptr : found;
}

int replay_all(const std::filesystem::path& corpus, std::vector<std::filesystem::path> files) {
  if (files.empty()) {
    for (const Target& target : kTargets) {
      const auto all = files_in(corpus / target.name);
      if (all.empty()) throw Error((corpus / target.name).string(), "is empty", "make a corpus");
      files.insert(files.end(), all.begin(), all.end());
    }
  }
  int failed = 0;
  int refused = 0;
  for (const auto& file : files) {
    const std::string folder = file.parent_path().filename().string();
    const Target* const target = target_named(folder);
    if (target == nullptr)
      throw Error(file.string(), "is not in the folder of a target", "move it");
    const Outcome outcome = replay(*target, corpus / folder / file.filename());
    failed += outcome.failed ? 1 : 0;
    refused += outcome.refused && !outcome.failed ? 1 : 0;
    fmt::print("{:<4} {}/{}: {}\n", outcome.failed ? "FAIL" : "ok", folder,
               file.filename().string(), outcome.text);
  }
  fmt::print("{} files: {} read, {} refused, {} failed\n", files.size(),
             static_cast<int>(files.size()) - refused - failed, refused, failed);
  return failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace pillarfield::fuzz

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "Usage: fuzz_replay CORPUS [FOLDER/NAME...]\n");
    return 2;
  }
  try {
    return pillarfield::fuzz::replay_all(argv[1], {argv + 2, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "fuzz_replay: {}\n", error.what());
    return 1;
  }
}
