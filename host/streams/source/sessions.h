#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace pillarfield {

/// Follows the sessions of a sensor: the newest one counts. One that it replaced counts again only
/// when the newest has sent nothing for a second.
class Sessions {
 public:
  enum class Kind : std::uint8_t { current, started, replaced };

  /// Classifies the session of an arrived packet. The first session of all is `current`.
  Kind classify(std::uint64_t session, std::chrono::nanoseconds arrived);

 private:
  [[nodiscard]] bool was_replaced(std::uint64_t session) const;

  std::array<std::uint64_t, 8> replaced_ = {};
  std::uint64_t replacements_ = 0;
  std::uint64_t current_ = 0;
  bool known_ = false;
  std::chrono::nanoseconds heard_{0};
};

/// Turns a sensor's clock into seconds since the first frame that rise from frame to frame. A frame
/// after a restart or a jump of the clock, or without a clock, is as much later than the frame
/// before as their times of arrival are.
class SensorClock {
 public:
  /// Time of the next frame, s. `time_ns` 0: the sensor has no clock.
  double seconds(std::uint64_t time_ns, std::chrono::nanoseconds arrived, bool restarted);

  /// Number of times that the clock went back, or ahead of the arrivals by over a second.
  [[nodiscard]] std::uint64_t jumps() const { return jumps_; }

 private:
  bool started_ = false;
  std::uint64_t last_ns_ = 0;
  std::chrono::nanoseconds last_arrived_{0};
  std::uint64_t elapsed_ns_ = 0;
  std::uint64_t jumps_ = 0;
};

/// A sequence number that is further back or ahead is that of a sensor that started again
/// (docs/stream_format.md).
inline constexpr std::uint64_t kFarBack = 1000;
inline constexpr std::uint64_t kFarAhead = 1 << 20;
/// So is one near zero after at least as many frames as PartHistory can tell late packets of.
inline constexpr std::uint64_t kNearZero = 8;
inline constexpr std::uint64_t kFewFrames = 32;
/// And one that is back at all after the end of the sequence, or after so long without packets.
inline constexpr std::chrono::milliseconds kLongestGap{500};

}  // namespace pillarfield
