#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "viewer/field/field_producer.h"
#include "viewer/field/playback.h"

namespace pillarfield::viewer {

/// What was measured since the player was made, and lately (the last second or so).
struct PlayerStatistics {
  std::uint64_t produced = 0;    ///< fields solved or read
  std::uint64_t taken = 0;       ///< of them, given to the display
  std::uint64_t not_shown = 0;   ///< replaced by a newer one before the display took them
  double produced_hz = 0;        ///< lately
  double produce_ms_median = 0;  ///< time to solve or read one field, lately
  double produce_ms_worst = 0;
  double behind_ms = 0;  ///< by how much the play head is late
};

/// The state of the play head, copied.
struct PlayerState {
  std::uint64_t frame = 0;
  std::uint64_t frames = 0;
  bool playing = false;
  bool loops = true;
  bool follows = false;
  double speed = 1;
  double rate_hz = 0;
};

/// Produces fields in a thread of its own as the play head asks for them, and never waits for the
/// display: one field waits to be taken, and a newer one replaces it (counted). All members may be
/// called from the display's thread while it runs.
class Player {
 public:
  explicit Player(std::unique_ptr<FieldProducer> producer);
  ~Player();  ///< stops the thread

  [[nodiscard]] const SourceInfo& info() const;

  void play();
  void pause();
  void seek(std::uint64_t frame);
  void step(std::int64_t frames);
  void set_speed(double speed);
  void set_rate(double rate_hz);
  void set_loop(bool loop);
  void set_follow(bool follow);

  [[nodiscard]] PlayerState state() const;
  [[nodiscard]] PlayerStatistics statistics() const;

  /// The newest field that was not taken yet; none where there is none. Throws the Error that ended
  /// the producing thread, once.
  [[nodiscard]] std::optional<ShownField> take();

  /// Called from the player's thread when a field waits to be taken (to wake the display).
  void on_new_field(std::function<void()> wake);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield::viewer
