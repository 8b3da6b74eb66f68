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

constexpr int kOutputDescriptor = 3;  // the child's end of the pipe

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

/// Closes all files but the pipe, and replaces the standard streams by /dev/null: a file inherited
/// from the parent would share its position.
void leave_only(int output) {
  output = fcntl(output, F_DUPFD, kOutputDescriptor + 1);
  const int nothing = open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, standard);
  dup2(output, kOutputDescriptor);
#if defined(__linux__) && defined(SYS_close_range)
  syscall(SYS_close_range, kOutputDescriptor + 1, ~0U, 0);
#endif
}

void write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t put = write(file, text.data() + done, text.size() - done);
    if (put < 0 && errno != EINTR) return;
    if (put > 0) done += static_cast<std::size_t>(put);
  }
}

[[noreturn]] void be_child(int output, const ChildLimits& limits,
                           const std::function<std::string()>& work) {
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  reset_signals();
  leave_only(output);
  limit_child(limits);
  write_all(kOutputDescriptor, work() + '\0');
  _exit(0);
}

/// Reads to the end of the pipe; false if `deadline` came first.
bool read_output(int output, ChildClock::time_point deadline, std::string& text) {
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - ChildClock::now());
    if (left.count() <= 0) return false;
    pollfd waiting = {output, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(left.count()));
    if (ready < 0 && errno != EINTR) return false;
    if (ready <= 0) continue;
    char block[512];
    const ssize_t got = read(output, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return true;
    text.append(block, static_cast<std::size_t>(got));
    if (text.back() == '\0') return true;
  }
}

/// The signal that ended the child; 0 if none did or another thread waited for the child.
int signal_of_end(pid_t child) {
  int status = 0;
  pid_t ended = 0;
  do ended = waitpid(child, &status, 0);
  while (ended < 0 && errno == EINTR);
  return ended == child && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

[[noreturn]] void fail_to_start(const std::string& where) {
  throw Error(where,
              std::string("cannot be checked in a separate process: ") + std::strerror(errno),
              "allow another process, or trust the file with --trust-input");
}

}  // namespace

ChildEnd run_in_child(const std::string& where, const ChildLimits& limits,
                      const std::function<int()>& do_fork,
                      const std::function<std::string()>& work) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail_to_start(where);
  const pid_t child = do_fork();
  if (child == 0) be_child(ends[1], limits, work);
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    fail_to_start(where);
  }
  ChildEnd end;
  end.in_time = read_output(ends[0], ChildClock::now() + limits.time, end.text);
  close(ends[0]);
  if (!end.in_time) kill(child, SIGKILL);
  end.signal = signal_of_end(child);
  if (end.signal == SIGXCPU) end.in_time = false;
  end.returned = !end.text.empty() && end.text.back() == '\0';
  if (end.returned) end.text.pop_back();
  return end;
}

}  // namespace pillarfield
