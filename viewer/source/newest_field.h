#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "viewer/source/player.h"
#include "viewer/source/recent_times.h"

namespace pillarfield::viewer {

/// Hands the newest field of a live source to the display, and counts those that it did not take;
/// the members of Player of these names do so. Thread safe.
class NewestField {
 public:
  /// Counts a field, with the time from its arrival until now.
  void count(std::chrono::nanoseconds arrived);
  /// Replaces the field that waits, and wakes the display.
  void set(ShownField field);
  /// take() throws this once after the last field; wakes the display.
  void fail(std::exception_ptr failure);
  void wake_display();

  [[nodiscard]] std::optional<ShownField> take();
  [[nodiscard]] PlayerStatistics statistics() const;
  void on_new_field(std::function<void()> wake);

 private:
  mutable std::mutex mutex_;  ///< guards the members up to `failed_`
  std::optional<ShownField> waiting_;
  std::uint64_t produced_ = 0;
  std::uint64_t taken_ = 0;
  mutable RecentTimes times_;
  std::exception_ptr failed_;
  std::mutex waking_;  ///< guards `wake_`, also while it runs
  std::function<void()> wake_;
};

/// Times of the fields of a live source in seconds since a start, which rise from field to field.
class FieldClock {
 public:
  explicit FieldClock(std::chrono::nanoseconds start) : start_(start) {}

  /// Follows the sensor's clock from the first frame on, which evens out delays on the way; where
  /// it stands still, jumps, or leaves the time of arrival, takes that.
  double time_s(double sensor_s, std::chrono::nanoseconds arrived);

 private:
  std::chrono::nanoseconds start_;
  double last_s_ = -1;              ///< of the field before
  std::optional<double> offset_s_;  ///< that time less the sensor's
};

}  // namespace pillarfield::viewer
