#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace pillarfield::viewer {

/// The play head: which frame's turn it is. No threads, no clock of its own: `now` is given.
///
/// While it plays, frames come due at rate_hz · speed, none is left out, and at the end it starts
/// anew (loop) or stops at the last frame. When whoever solves cannot keep up, frames come late and
/// the head does not run ahead by more than one second: `behind()` tells by how much it is late.
class Playback {
 public:
  using Time = std::chrono::nanoseconds;

  Playback(std::uint64_t frames, double rate_hz);

  void play(Time now);
  void pause();
  void seek(std::uint64_t frame, Time now);  ///< clamped; shows it whether playing or not
  void step(std::int64_t frames, Time now);  ///< pauses; wraps around in a loop, else clamped
  void set_speed(double speed, Time now);    ///< 0.01..100; 1 is the source's own time
  void set_rate(double rate_hz, Time now);   ///< frames per second at speed 1
  void set_loop(bool loop);
  void set_follow(bool follow, Time now);           ///< the head stays at the newest frame
  void set_frames(std::uint64_t frames, Time now);  ///< the source has grown

  /// The frame to be made now, each once; none where nothing is due.
  [[nodiscard]] std::optional<std::uint64_t> next(Time now);

  /// When next() will have one, at the earliest; none while it is paused.
  [[nodiscard]] std::optional<Time> next_due() const;

  [[nodiscard]] std::uint64_t frame() const;  ///< the last one that next() gave, or that was sought
  [[nodiscard]] std::uint64_t frames() const;
  [[nodiscard]] bool playing() const;
  [[nodiscard]] bool loops() const;
  [[nodiscard]] bool follows() const;
  [[nodiscard]] double speed() const;
  [[nodiscard]] double rate_hz() const;
  [[nodiscard]] Time behind(Time now) const;

 private:
  // (yours)
};

}  // namespace pillarfield::viewer
