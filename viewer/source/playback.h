#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace pillarfield::viewer {

/// The play head: schedules frames. It has no thread and no clock; the caller passes a monotonic
/// `now`.
///
/// The first frame is due at once. While playing, every frame comes due, at rate_hz · speed; at the
/// end the head loops or stops. Where the solver is too slow, frames are late by at most a second.
class Playback {
 public:
  using Time = std::chrono::nanoseconds;

  /// Throws Error where there is no frame. A rate out of 0.001..1e6 Hz becomes its limit.
  Playback(std::uint64_t frames, double rate_hz);

  void play(Time now);  ///< restarts from the first frame after stopping at the last
  void pause();
  void seek(std::uint64_t frame, Time now);  ///< clamped; also while paused
  void again(Time now);                      ///< produces the current frame once more
  void step(std::int64_t frames, Time now);  ///< pauses; wraps in a loop, else clamps
  void set_speed(double speed, Time now);    ///< 0.01..100; 1 is real time
  void set_loop(bool loop);
  /// Stays at the newest frame as frames are added, without playing; play(), pause(), seek() and
  /// step() end it.
  void set_follow(bool follow, Time now);
  void set_frames(std::uint64_t frames, Time now);  ///< the source has grown

  /// Returns the frame to produce now, each once; none where nothing is due.
  [[nodiscard]] std::optional<std::uint64_t> next(Time now);

  /// Earliest time at which next() returns a frame; none while paused.
  [[nodiscard]] std::optional<Time> next_due() const;

  [[nodiscard]] std::uint64_t frame() const { return frame_; }  ///< last result of next() or seek()
  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] bool playing() const { return playing_; }
  [[nodiscard]] bool loops() const { return loops_; }
  [[nodiscard]] bool follows() const { return follows_; }
  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] double rate_hz() const { return rate_hz_; }

 private:
  /// Due time of the next frame while playing.
  [[nodiscard]] Time due() const;
  [[nodiscard]] double period_ns() const { return 1e9 / (rate_hz_ * speed_); }
  [[nodiscard]] std::uint64_t last() const { return frames_ - 1; }
  void show(std::uint64_t frame, Time since);
  void restart(Time first_due);
  std::uint64_t give(std::uint64_t frame);

  std::uint64_t frames_;
  double rate_hz_;
  double speed_ = 1;
  bool playing_ = false;
  bool loops_ = true;
  bool follows_ = false;
  std::uint64_t frame_ = 0;
  std::optional<Time> shown_since_;  ///< time since which frame_ is due; none once produced
  /// Frame `played_` is due at first_due_ + played_ periods: a product does not drift, a sum would.
  Time first_due_{0};
  std::uint64_t played_ = 0;
};

}  // namespace pillarfield::viewer
