#pragma once

#include <chrono>

namespace pillarfield {

/// Time that a paced stream goes by; tests have one of their own.
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
