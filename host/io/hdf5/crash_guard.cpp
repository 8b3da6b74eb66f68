#include "io/hdf5/crash_guard.h"

#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "pillarfield/printable.h"

namespace pillarfield::hdf5 {
namespace {

constexpr double kMostProcessorSeconds = 2;
constexpr double kLeastBytesPerSecond = 1 << 24;
constexpr std::array kFatalSignals = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU};

thread_local const CrashGuard* guarding = nullptr;

/// Actions of the fatal signals before ours.
std::map<int, struct sigaction>& former_actions() {
  static std::map<int, struct sigaction> actions;
  return actions;
}

}  // namespace

void CrashGuard::end_process(int signal, siginfo_t* facts, void*) {
  const bool is_late = signal == SIGXCPU && facts->si_code == SI_TIMER;
  if (guarding == nullptr && is_late) return;  // The timer of a guard that has ended.
  if (guarding == nullptr) {
    // The instruction, or abort(), raises the signal again.
    sigaction(signal, &former_actions().at(signal), nullptr);
    if (signal == SIGXCPU) raise(signal);
    return;
  }
  const std::string_view line = is_late ? guarding->late_ : guarding->crashed_;
  [[maybe_unused]] const ssize_t put = ::write(STDERR_FILENO, line.data(), line.size());
  _exit(1);
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
CrashGuard::CrashGuard(const std::filesystem::path& file, bool trusted, double bytes) {
  if (trusted || (guarding != nullptr && guarding->has_timer_)) return;
  is_active_ = true;
  const std::string name = printable(file.string());
  constexpr const char* kMend = "the file is damaged; use another copy";
  crashed_ = fmt::format("pillarfield: {}: reading it crashes the {}; {}\n", name,
                         bytes == kNoLimit ? "program" : "HDF5 library", kMend);
  late_ = fmt::format("pillarfield: {}: HDF5 does not finish reading it; {}\n", name, kMend);
  handle_signals();
  const stack_t ours = {stack_.data(), 0, stack_.size()};
  sigaltstack(&ours, &stack_before_);
  former_ = std::exchange(guarding, this);
  if (bytes == kNoLimit) return;
#ifdef __linux__
  sigevent event = {};
  event.sigev_notify = SIGEV_THREAD_ID;
  event.sigev_signo = SIGXCPU;
  event._sigev_un._tid = static_cast<pid_t>(syscall(SYS_gettid));
  has_timer_ = timer_create(CLOCK_THREAD_CPUTIME_ID, &event, &timer_) == 0;
  const double most_s = kMostProcessorSeconds + bytes / kLeastBytesPerSecond;
  const itimerspec limit = {{}, {static_cast<time_t>(std::ceil(most_s)), 0}};
  if (has_timer_) timer_settime(timer_, 0, &limit, nullptr);
#endif
}

CrashGuard::~CrashGuard() {
  if (!is_active_) return;
  if (has_timer_) timer_delete(timer_);
  guarding = former_;
  sigaltstack(&stack_before_, nullptr);
}

}  // namespace pillarfield::hdf5
