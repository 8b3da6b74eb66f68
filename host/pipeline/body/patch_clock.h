#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace pillarfield {

/// The host's time of a sensor's clock: offset and drift, from the packets that waited least.
///
/// A packet arrives after it was scanned, so the difference of the clocks is at most that of the
/// arrival: the least one of each half second, and a line through those of the last eight seconds.
class PatchClock {
 public:
  using Time = std::chrono::nanoseconds;

  /// A packet scanned at `device_ns` by the sensor's clock, above 0, that arrived at `arrived`.
  void add(std::uint64_t device_ns, Time arrived);

  /// The host's time of a moment of the sensor's clock, after add().
  [[nodiscard]] Time host_time(std::uint64_t device_ns) const;

 private:
  struct Least {
    double device_s = 0;  ///< since origin_ns_
    double ahead_s = 0;   ///< host time minus device time, both since the origins
  };
  static constexpr std::size_t kWindows = 16;

  [[nodiscard]] double seconds(std::uint64_t device_ns) const;
  void fit();

  bool started_ = false;
  std::uint64_t origin_ns_ = 0;
  Time host_origin_{0};
  std::array<Least, kWindows> least_{};
  std::size_t windows_ = 0;    ///< begun
  double window_began_s_ = 0;  ///< by the sensor's clock
  double offset_s_ = 0;        ///< of the line, at mean_s_
  double mean_s_ = 0;
  double drift_ = 0;
};

}  // namespace pillarfield
