#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "pillarfield/live.h"
#include "viewer/source/player.h"
#include "viewer/source/recent_times.h"

namespace pillarfield::viewer {

/// The state of a sensor.
struct LiveStatus {
  HealthReport health;
  bool ended = false;  ///< no frame will follow
  bool taring = false;
  std::string recording;             ///< file; empty: none
  LiveSinkStatistics recorded = {};  ///< of that file
  std::string message;               ///< about the last tare or recording
  std::uint64_t messages = 0;        ///< how many there were
};

/// "12 frames, 3 dropped, failed: the disk is full".
[[nodiscard]] std::string recorded_words(const LiveSinkStatistics& recorded);

/// What a user can do with a sensor. Results of another program have no tare and no raw frames:
/// then SourceInfo::has_readings is false.
class LiveControl {
 public:
  virtual ~LiveControl() = default;
  /// Takes the mean of the readings of the next half second as tare of an untouched skin.
  virtual void tare() = 0;
  /// Records the raw frames from now on. Throws Error where the file cannot be made, and for
  /// results.
  virtual void record(const std::filesystem::path& path) = 0;
  virtual void stop_recording() = 0;
  [[nodiscard]] virtual LiveStatus status() const = 0;
};

/// Hands the newest field of a live source to the display, and counts those that it did not take.
/// Thread safe.
class NewestField {
 public:
  /// Counts a field, with the time from its arrival until now.
  void count(std::chrono::nanoseconds arrived);
  /// Replaces the field that waits, and wakes the display.
  void set(ShownField field);
  /// take() throws `failure`, unless it is null, once after the last field; wakes the display.
  void end(std::exception_ptr failure);

  // As Player has them.
  [[nodiscard]] std::optional<ShownField> take();
  [[nodiscard]] PlayerStatistics statistics() const;
  void on_new_field(std::function<void()> wake);

 private:
  void wake_display();

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

/// A live source on display: a thread of the derived class produces fields for `newest_` as they
/// are `wanted_`, and none while paused.
class LiveView : public Player, public LiveControl {
 public:
  void play() override { wanted_.paused = false; }
  void pause() override { wanted_.paused = true; }
  void seek(std::uint64_t /*frame*/) override {}
  void step(std::int64_t /*frames*/) override {}
  void set_speed(double /*speed*/) override {}
  void set_rate(double /*rate_hz*/) override {}
  void set_loop(bool /*loop*/) override {}
  void set_follow(bool /*follow*/) override {}
  void set_contacts(bool wanted) override { wanted_.contacts = wanted; }
  void set_peak(bool wanted) override {
    wanted_.peak_anew = wanted;
    wanted_.peak = wanted;
  }
  [[nodiscard]] PlayerStatistics statistics() const override { return newest_.statistics(); }
  [[nodiscard]] std::optional<ShownField> take() override { return newest_.take(); }
  void on_new_field(std::function<void()> wake) override { newest_.on_new_field(std::move(wake)); }
  [[nodiscard]] LiveControl* live() override { return this; }

 protected:
  struct Wanted {
    std::atomic<bool> paused = false;
    std::atomic<bool> contacts = false;
    std::atomic<bool> peak = false;
    std::atomic<bool> peak_anew = false;
  };
  [[nodiscard]] PlayerState state_after(std::uint64_t frames, double rate_hz) const;

  NewestField newest_;
  Wanted wanted_;
};

}  // namespace pillarfield::viewer
