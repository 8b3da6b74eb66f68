#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace pillarfield::cli {

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
