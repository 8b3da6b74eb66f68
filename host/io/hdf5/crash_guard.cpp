#include "io/hdf5/crash_guard.h"

#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <string_view>
#include <utility>

#include "pillarfield/crash.h"
#include "pillarfield/printable.h"

namespace pillarfield::hdf5 {
namespace {

constexpr time_t kMostProcessorSeconds = 2;
constexpr std::array kFatalSignals = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU};

thread_local const CrashGuard* guarding = nullptr;

/// A line on the file that was read last, for crashes after it.
std::atomic<const std::string*> last_read = nullptr;

/// See exit_after_crashes().
std::atomic<bool> exits = false;

/// Actions of the fatal signals before ours.
std::map<int, struct sigaction>& former_actions() {
  static std::map<int, struct sigaction> actions;
  return actions;
}

void remember(std::string line) {
  static std::mutex mutex;
  static std::set<std::string> lines;  // Their addresses stay valid.
  const std::lock_guard lock(mutex);
  last_read = &*lines.insert(std::move(line)).first;
}

}  // namespace

void CrashGuard::end_process(int signal, siginfo_t* facts, void*) {
  const bool is_late = signal == SIGXCPU && facts->si_code == SI_TIMER;
  if (guarding == nullptr && is_late) return;  // The timer of a guard that has ended.
  const struct sigaction& former = former_actions().at(signal);
  const bool is_ours = signal != SIGXCPU && former.sa_handler == SIG_DFL;
  if (guarding == nullptr && !is_ours) {
    // The instruction, or abort(), raises the signal again.
    sigaction(signal, &former, nullptr);
    if (signal == SIGXCPU) raise(signal);
    return;
  }
  const std::string_view line = guarding == nullptr ? *last_read.load()
                                : is_late           ? guarding->late_
                                                    : guarding->crashed_;
  [[maybe_unused]] const ssize_t put = ::write(STDERR_FILENO, line.data(), line.size());
  if (guarding != nullptr || exits) _exit(1);
  sigaction(signal, &former, nullptr);
}

void CrashGuard::handle_signals() {
  static const bool once = [] {
    struct sigaction action = {};
    action.sa_sigaction = end_process;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    for (const int signal : kFatalSignals) sigaction(signal, &action, &former_actions()[signal]);
    return true;
  }();
  (void)once;
}

// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): the stack needs no values
CrashGuard::CrashGuard(const std::filesystem::path& file, bool trusted) {
  if (trusted || guarding != nullptr) return;
  is_outer_ = true;
  const std::string name = printable(file.string());
  constexpr const char* kMend = "the file is damaged; use another copy";
  crashed_ = fmt::format("pillarfield: {}: reading it crashes the HDF5 library; {}\n", name, kMend);
  late_ = fmt::format("pillarfield: {}: HDF5 does not finish reading it; {}\n", name, kMend);
  remember(
      fmt::format("pillarfield: {}: the program crashes after reading it; the file may be "
                  "damaged: use another copy, or report it\n",
                  name));
  handle_signals();
  const stack_t ours = {stack_.data(), 0, stack_.size()};
  sigaltstack(&ours, &stack_before_);
  guarding = this;
#ifdef __linux__
  sigevent event = {};
  event.sigev_notify = SIGEV_THREAD_ID;
  event.sigev_signo = SIGXCPU;
  event._sigev_un._tid = static_cast<pid_t>(syscall(SYS_gettid));
  has_timer_ = timer_create(CLOCK_THREAD_CPUTIME_ID, &event, &timer_) == 0;
  const itimerspec limit = {{}, {kMostProcessorSeconds, 0}};
  if (has_timer_) timer_settime(timer_, 0, &limit, nullptr);
#endif
}

CrashGuard::~CrashGuard() {
  if (!is_outer_) return;
  if (has_timer_) timer_delete(timer_);
  guarding = nullptr;
  sigaltstack(&stack_before_, nullptr);
}

}  // namespace pillarfield::hdf5

namespace pillarfield {

void exit_after_crashes() { hdf5::exits = true; }

}  // namespace pillarfield
