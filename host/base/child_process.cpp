#include "base/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#include <sys/syscall.h>
#endif

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield {
namespace {

using ChildClock = std::chrono::steady_clock;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kShadowMemory = true;  // AddressSanitizer maps terabytes
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kShadowMemory = true;
#else
constexpr bool kShadowMemory = false;
#endif
#else
constexpr bool kShadowMemory = false;
#endif

/// `resource` is an enumeration in some C libraries, and an int in others.
template <class Resource>
void lower_limit(Resource resource, rlim_t soft, rlim_t hard) {
  rlimit limit = {};
  if (getrlimit(resource, &limit) != 0) return;
  limit.rlim_max = std::min(limit.rlim_max, hard);
  limit.rlim_cur = std::min({limit.rlim_cur, soft, limit.rlim_max});
  setrlimit(resource, &limit);
}

/// Size of the process's address space, bytes; 0 where unknown.
rlim_t mapped_bytes() {
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  char text[64] = "";
  const ssize_t got = read(file, text, sizeof text - 1);
  close(file);
  rlim_t pages = 0;
  for (ssize_t i = 0; i < got && text[i] >= '0' && text[i] <= '9'; ++i) {
    pages = 10 * pages + static_cast<rlim_t>(text[i] - '0');
  }
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void limit_child(const ChildLimits& limits) {
  lower_limit(RLIMIT_CORE, 0, 0);
  lower_limit(RLIMIT_CPU, limits.processor_s, limits.processor_s + 1);
  const rlim_t mapped = mapped_bytes();
  if (kShadowMemory || mapped == 0) return;
  lower_limit(RLIMIT_AS, mapped + limits.memory_bytes, mapped + limits.memory_bytes);
}

/// An interrupt from the terminal reaches parent and child; only the parent handles it.
void reset_signals() {
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  for (const int signal : {SIGINT, SIGHUP, SIGQUIT}) std::signal(signal, SIG_IGN);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// Closes all files but `output` and `input`, and replaces the standard streams by /dev/null: a
/// file inherited from the parent would share its position. Returns the new number of `output`.
int leave_only(int output, int input) {
  constexpr int kFirst = STDERR_FILENO + 1;
  output = fcntl(output, F_DUPFD, kFirst);
  const int nothing = open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (standard != input) dup2(nothing, standard);
  }
#if defined(__linux__) && defined(SYS_close_range)
  int first = kFirst;
  for (const int kept : {std::min(input, output), std::max(input, output)}) {
    if (kept > first) syscall(SYS_close_range, first, kept - 1, 0);
    first = std::max(first, kept + 1);
  }
  syscall(SYS_close_range, first, ~0U, 0);
#endif
  return output;
}

void write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t put = write(file, text.data() + done, text.size() - done);
    if (put < 0 && errno != EINTR) return;
    if (put > 0) done += static_cast<std::size_t>(put);
  }
}

[[noreturn]] void be_child(int output, int input, const ChildLimits& limits,
                           const std::function<std::string()>& work) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  reset_signals();
  output = leave_only(output, input);
  limit_child(limits);
  write_all(output, work() + '\0');
  _exit(0);
}

/// Reads to the end of the pipe.
ChildEnd::Reason read_output(int output, ChildClock::time_point deadline, std::string& text) {
  constexpr int kIntervalMs = 100;  // A child that needs less is not interrupted.
  while (ChildClock::now() < deadline) {
    pollfd waiting = {output, POLLIN, 0};
    const int ready = poll(&waiting, 1, kIntervalMs);
    if (ready < 0 && errno != EINTR) break;
    if (ready == 0 && is_interrupted()) return ChildEnd::Reason::interrupted;
    if (ready <= 0) continue;
    char block[512];
    const ssize_t got = read(output, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return ChildEnd::Reason::died;
    text.append(block, static_cast<std::size_t>(got));
    if (text.back() == '\0') return ChildEnd::Reason::returned;
  }
  return ChildEnd::Reason::late;
}

std::chrono::microseconds duration(const timeval& time) {
  return std::chrono::seconds(time.tv_sec) + std::chrono::microseconds(time.tv_usec);
}

/// Leaves `end` as it is if another thread waited for the child.
void wait_for_child(pid_t child, ChildEnd& end) {
  int status = 0;
  rusage used = {};
  pid_t ended = 0;
  do ended = wait4(child, &status, 0, &used);
  while (ended < 0 && errno == EINTR);
  if (ended != child) return;
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  end.processor_time = duration(used.ru_utime) + duration(used.ru_stime);
}

[[noreturn]] void fail_to_start(const std::string& where) {
  throw Error(where,
              std::string("cannot be checked in a separate process: ") + std::strerror(errno),
              "allow another process, or trust the file with --trust-input");
}

}  // namespace

ChildEnd run_in_child(const std::string& where, const ChildLimits& limits, int input,
                      const std::function<int()>& do_fork,
                      const std::function<std::string()>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail_to_start(where);
  const pid_t child = do_fork();
  if (child == 0) be_child(ends[1], input, limits, work);
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    fail_to_start(where);
  }
  ChildEnd end;
  end.reason = read_output(ends[0], ChildClock::now() + limits.time, end.text);
  close(ends[0]);
  if (end.reason == ChildEnd::Reason::returned) {
    end.text.pop_back();
  } else if (end.reason != ChildEnd::Reason::died) {
    kill(child, SIGKILL);
  }
  wait_for_child(child, end);
  return end;
}

}  // namespace pillarfield
