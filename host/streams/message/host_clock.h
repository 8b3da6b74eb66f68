#pragma once

#include <chrono>

namespace pillarfield {

/// Converts times of arrival, std::steady_clock, to the host's real time. The offset is that of the
/// start, so that stamps stay monotonic when somebody sets the clock.
class HostClock {
 public:
  /// Nanoseconds since 1970; of now if the time of arrival is not set.
  [[nodiscard]] std::chrono::nanoseconds real_time(std::chrono::nanoseconds arrived) const {
    using std::chrono::steady_clock;
    return offset_ + (arrived.count() != 0 ? arrived : steady_clock::now().time_since_epoch());
  }

 private:
  std::chrono::nanoseconds offset_ = std::chrono::system_clock::now().time_since_epoch() -
                                     std::chrono::steady_clock::now().time_since_epoch();
};

}  // namespace pillarfield
