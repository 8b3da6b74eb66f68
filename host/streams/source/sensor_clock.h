#pragma once

#include <chrono>
#include <cstdint>

namespace pillarfield {

/// Turns a sensor's clock into seconds since the first frame that rise from frame to frame. A frame
/// after a restart or a jump of the clock, or without a clock, is as much later than the frame
/// before as their times of arrival are.
class SensorClock {
 public:
  /// Time of the next frame, s. `time_ns` 0: the sensor has no clock.
  double seconds(std::uint64_t time_ns, std::chrono::nanoseconds arrived, bool restarted);

  /// How often the clock went back, or ahead of the arrivals by over a second.
  [[nodiscard]] std::uint64_t jumps() const { return jumps_; }

 private:
  bool started_ = false;
  std::uint64_t last_ns_ = 0;
  std::chrono::nanoseconds last_arrived_{0};
  std::uint64_t elapsed_ns_ = 0;
  std::uint64_t jumps_ = 0;
};

}  // namespace pillarfield
