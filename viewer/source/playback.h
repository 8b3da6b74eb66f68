#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace pillarfield::viewer {

/// The play head: which frame's turn it is. No threads, no clock of its own: `now` is given, and
/// never runs backwards.
///
/// The first frame is due at once. While it plays, frames come due at rate_hz · speed, none is left
/// out, and at the end it starts anew (loop) or stops at the last frame. When whoever solves cannot
/// keep up, frames come late and the head does not run ahead by more than one second: `behind()`
/// tells by how much it is late.
class Playback {
 public:
  using Time = std::chrono::nanoseconds;

  /// Throws Error where there is no frame. A rate out of set_rate()'s range becomes its limit.
  Playback(std::uint64_t frames, double rate_hz);

  void play(Time now);  ///< from the first frame where it stopped at the last one
  void pause();
  void seek(std::uint64_t frame, Time now);  ///< clamped; shows it whether playing or not
  void again(Time now);                      ///< makes the frame that is shown once more
  void step(std::int64_t frames, Time now);  ///< pauses; wraps around in a loop, else clamped
  void set_speed(double speed, Time now);    ///< 0.01..100; 1 is the source's own time
  void set_rate(double rate_hz, Time now);   ///< frames per second at speed 1, 0.001..1e6
  void set_loop(bool loop);
  /// The head goes to the newest frame and stays there as frames are added, and does not play;
  /// play(), pause(), seek() and step() end that.
  void set_follow(bool follow, Time now);
  void set_frames(std::uint64_t frames, Time now);  ///< the source has grown

  /// The frame to be made now, each once; none where nothing is due.
  [[nodiscard]] std::optional<std::uint64_t> next(Time now);

  /// When next() will have one, at the earliest; none while it is paused.
  [[nodiscard]] std::optional<Time> next_due() const;

  [[nodiscard]] std::uint64_t frame() const { return frame_; }  ///< last given by next() or sought
  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] bool playing() const { return playing_; }
  [[nodiscard]] bool loops() const { return loops_; }
  [[nodiscard]] bool follows() const { return follows_; }
  [[nodiscard]] double speed() const { return speed_; }
  [[nodiscard]] double rate_hz() const { return rate_hz_; }
  [[nodiscard]] Time behind(Time now) const;  ///< 0..1 s

 private:
  /// Of the frame that playing gives next.
  [[nodiscard]] Time due() const;
  [[nodiscard]] double period_ns() const { return 1e9 / (rate_hz_ * speed_); }
  [[nodiscard]] std::uint64_t last() const { return frames_ - 1; }
  void show(std::uint64_t frame, Time since);
  void restart(Time first_due);
  /// Changes the pace in the middle of a period: what is left of it is stretched or shortened.
  void change_pace(double& pace, double value, Time now);
  std::uint64_t give(std::uint64_t frame);

  std::uint64_t frames_;
  double rate_hz_;
  double speed_ = 1;
  bool playing_ = false;
  bool loops_ = true;
  bool follows_ = false;
  std::uint64_t frame_ = 0;
  std::optional<Time> shown_since_;  ///< frame_ is to be made, and since when
  /// Frame number `played_` since then is due so many periods after it: times are not added up,
  /// so that they do not drift.
  Time first_due_{0};
  std::uint64_t played_ = 0;
};

}  // namespace pillarfield::viewer
