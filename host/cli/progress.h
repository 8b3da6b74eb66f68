#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

namespace pillarfield::cli {

/// What prints a line to standard error; empty where that is no terminal, or `quiet` is asked for.
[[nodiscard]] std::function<void(const std::string&)> terminal_line(bool quiet);

/// A line on the terminal that shows how far a long job is: only where standard error is a
/// terminal, and rewritten at most ten times a second.
class Progress {
 public:
  /// `verb`, as "Solving"; `frames` in all.
  Progress(std::string verb, std::uint64_t frames, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// So many frames are done.
  void show(std::uint64_t done);

 private:
  using Clock = std::chrono::steady_clock;
  std::string verb_;
  std::uint64_t frames_;
  bool visible_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_ + std::chrono::milliseconds(300);
};

}  // namespace pillarfield::cli
