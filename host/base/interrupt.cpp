#include "pillarfield/interrupt.h"

#include <csignal>

namespace pillarfield {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void note_interrupt(int /*signal*/) { interrupted = 1; }

void catch_signal(int signal) {
  struct sigaction action = {};
  action.sa_handler = note_interrupt;
  // Without SA_RESTART a blocking call, such as opening a pipe, ends.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) {
  struct sigaction action = {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void catch_interrupts() {
  catch_signal(SIGINT);
  catch_signal(SIGTERM);
  if (!is_ignored(SIGHUP)) catch_signal(SIGHUP);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool is_interrupted() { return interrupted != 0; }

}  // namespace pillarfield
