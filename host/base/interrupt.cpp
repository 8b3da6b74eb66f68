#include "pillarfield/interrupt.h"

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>

namespace pillarfield {
namespace {

std::atomic<bool> interrupted = false;  // lock-free: set in a signal handler too
pthread_t calling_thread;
sigset_t waited_signals;

void note_interrupt(int /*signal*/) { interrupted = true; }

void end_blocking_call(int /*signal*/) {}

void handle(int signal, void (*handler)(int), int flags) {
  struct sigaction action = {};
  action.sa_handler = handler;
  // Without SA_RESTART a blocking call, such as opening a pipe, ends.
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) {
  struct sigaction action = {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

[[noreturn]] void end_by(int signal) {
  handle(signal, SIG_DFL, 0);
  pthread_sigmask(SIG_UNBLOCK, &waited_signals, nullptr);
  raise(signal);
  std::_Exit(1);
}

/// A repeated signal ends the program, but not within this time: `timeout` sends its signal twice,
/// to the program and to its group.
constexpr std::chrono::milliseconds kOneSignal{500};

void* wait_for_signals(void* /*nothing*/) {
  using Clock = std::chrono::steady_clock;
  sigset_t seen;
  sigemptyset(&seen);
  Clock::time_point first;
  while (true) {
    int signal = 0;
    if (sigwait(&waited_signals, &signal) != 0) continue;
    if (sigismember(&seen, signal) == 1) {
      if (Clock::now() - first > kOneSignal) end_by(signal);
      continue;
    }
    sigaddset(&seen, signal);
    first = Clock::now();
    interrupted = true;
    pthread_kill(calling_thread, SIGURG);
  }
}

/// Starts the thread that waits for the signals, with a stack that a limited address space holds.
bool start_waiting() {
  constexpr std::size_t kStackBytes = std::size_t{128} << 10U;
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0) return false;
  pthread_attr_setstacksize(&attributes, kStackBytes);
  pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
  pthread_t thread = {};
  const int failure = pthread_create(&thread, &attributes, wait_for_signals, nullptr);
  pthread_attr_destroy(&attributes);
  return failure == 0;
}

}  // namespace

void catch_interrupts() {
  calling_thread = pthread_self();
  sigemptyset(&waited_signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (signal == SIGHUP && is_ignored(signal)) continue;
    sigaddset(&waited_signals, signal);
    handle(signal, note_interrupt, static_cast<int>(SA_RESETHAND));
  }
  handle(SIGURG, end_blocking_call, 0);
  std::signal(SIGXFSZ, SIG_IGN);
  // A compiler of OpenCL replaces handlers by its own, which removes the files that it is writing
  // and so makes it fail. No handler sees a signal that all threads block and one waits for.
  pthread_sigmask(SIG_BLOCK, &waited_signals, nullptr);
  if (!start_waiting()) pthread_sigmask(SIG_UNBLOCK, &waited_signals, nullptr);
}

bool is_interrupted() { return interrupted; }

}  // namespace pillarfield
