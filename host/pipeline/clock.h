#pragma once

#include <chrono>

namespace pillarfield {

/// The clock of a paced stream; tests supply their own.
class Clock {
 public:
  Clock() = default;
  virtual ~Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;

  [[nodiscard]] virtual std::chrono::nanoseconds now() = 0;

  /// May return early.
  virtual void sleep_until(std::chrono::nanoseconds time) = 0;
};

}  // namespace pillarfield
