#pragma once

#include <sys/prctl.h>

#include <chrono>
#include <ctime>

namespace pillarfield::cli {

/// The system's monotonic clock, for LiveRun.
class MonotonicClock {
 public:
  /// Sleeps of this thread end when they should, not up to 50 microseconds later, as Linux
  /// otherwise allows itself in order to wake less often.
  MonotonicClock() { prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL); }

  [[nodiscard]] static std::chrono::nanoseconds now() {
    return std::chrono::steady_clock::now().time_since_epoch();
  }

  /// Returns early where a signal comes in.
  static void sleep_until(std::chrono::nanoseconds time) {
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(time);
    const timespec until = {.tv_sec = whole.count(), .tv_nsec = (time - whole).count()};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  }
};

}  // namespace pillarfield::cli
