#include "cli/interrupt.h"

#include <fmt/format.h>

#include <csignal>

#include "pillarfield/error.h"

namespace pillarfield::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void note_interrupt(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, note_interrupt);
  std::signal(SIGTERM, note_interrupt);
}

bool is_interrupted() { return interrupted != 0; }

void stop_if_interrupted(std::uint64_t frames, const std::filesystem::path& output) {
  if (!is_interrupted()) return;
  throw Error(output.string(), fmt::format("interrupted after {} frames", frames),
              "an HDF5 output keeps them, under this name + \".part\"");
}

void stop_if_interrupted_before(const std::filesystem::path& output) {
  if (!is_interrupted()) return;
  throw Error(output.string(), "interrupted before it was written", "start again");
}

}  // namespace pillarfield::cli
