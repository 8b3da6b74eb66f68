#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "pillarfield/printable.h"

namespace pillarfield::cli {

std::function<void(const std::string&)> terminal_line(bool quiet) {
  if (quiet || isatty(STDERR_FILENO) != 1) return {};
  return [](const std::string& line) { fmt::print(stderr, "{}\n", printable(line)); };
}

Progress::Progress(std::string verb, std::uint64_t frames, bool quiet, const char* noun)
    : verb_(std::move(verb)),
      frames_(frames),
      noun_(noun),
      visible_(!quiet && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::show(std::uint64_t done) {
  if (!visible_ || done == 0 || Clock::now() < next_) return;
  const auto now = Clock::now();
  next_ = now + std::chrono::milliseconds(100);
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double left = seconds / static_cast<double>(done) * static_cast<double>(frames_ - done);
  fmt::print(stderr, "\r\033[K{}: {} {} of {} ({} %), about {:.0f} s left", verb_, noun_, done,
             frames_, 100 * done / frames_, left);
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::show(std::uint64_t done, std::uint64_t of) {
  frames_ = of;
  show(done);
}

}  // namespace pillarfield::cli
