#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "viewer/source/field_producer.h"
#include "viewer/source/playback.h"

namespace pillarfield::viewer {

/// What was measured since the player was made, and lately (the last second or so).
/// Of what was produced each field was taken, was not shown, or waits:
/// produced = taken + not_shown + waiting.
struct PlayerStatistics {
  std::uint64_t produced = 0;    ///< fields solved or read
  std::uint64_t taken = 0;       ///< of them, given to the display
  std::uint64_t not_shown = 0;   ///< replaced by a newer one before the display took them
  std::uint64_t waiting = 0;     ///< 0 or 1, not taken yet
  double produced_hz = 0;        ///< lately
  double produce_ms_median = 0;  ///< time to solve or read one field, and its contacts, lately
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
/// display: one field waits to be taken, and a newer one replaces it (counted). The first frame is
/// produced at once; nothing plays until play(). All members may be called from the display's
/// thread while it runs, and from any other.
///
/// While it follows, it looks ten times a second whether the source has grown. One field waits and
/// one is being made, so the display may hold FieldProducer::kMostShown - 2.
class Player {
 public:
  explicit Player(std::unique_ptr<FieldProducer> producer);
  ~Player();  ///< waits for the field that is being made; fields taken stay valid
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// As the source was at the beginning; state() tells how many frames it has now.
  [[nodiscard]] const SourceInfo& info() const;

  void play();
  void pause();
  void seek(std::uint64_t frame);
  void step(std::int64_t frames);
  void set_speed(double speed);
  void set_rate(double rate_hz);
  void set_loop(bool loop);
  void set_follow(bool follow);
  /// Whether fields come with their contacts; where they begin to, the one shown comes again.
  void set_contacts(bool wanted);

  [[nodiscard]] PlayerState state() const;
  [[nodiscard]] PlayerStatistics statistics() const;

  /// The newest field that was not taken yet; none where there is none. Throws what ended the
  /// producing thread, mostly an Error, once, when the fields made before are taken.
  [[nodiscard]] std::optional<ShownField> take();

  /// Calls `wake` from the player's thread when a field came to wait, or the thread ended by an
  /// error, to wake the display; what waits already is not told. `wake` may call all members but
  /// this one. When this returns, the `wake` before it is called no more.
  void on_new_field(std::function<void()> wake);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield::viewer
