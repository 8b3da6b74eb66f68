#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

namespace pillarfield::cli {

/// Returns a function that prints a line to standard error; empty if `quiet` or without a terminal.
[[nodiscard]] std::function<void(const std::string&)> terminal_line(bool quiet);

/// Shows the progress of a job on standard error if that is a terminal, at most ten times a second.
class Progress {
 public:
  /// `verb` is a word such as "Solving"; `noun` is what is counted.
  Progress(std::string verb, std::uint64_t frames, bool quiet, const char* noun = "frame");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::uint64_t done);
  void show(std::uint64_t done, std::uint64_t of);

 private:
  using Clock = std::chrono::steady_clock;
  std::string verb_;
  std::uint64_t frames_;
  const char* noun_;
  bool visible_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point next_ = start_ + std::chrono::milliseconds(300);
};

}  // namespace pillarfield::cli
