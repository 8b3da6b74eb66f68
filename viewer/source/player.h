#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "viewer/source/field_producer.h"
#include "viewer/source/playback.h"

namespace pillarfield::viewer {

/// Counts since construction, and rates and times over about the last second.
/// produced = taken + not_shown + waiting.
struct PlayerStatistics {
  std::uint64_t produced = 0;    ///< fields solved or read
  std::uint64_t taken = 0;       ///< passed to the display
  std::uint64_t not_shown = 0;   ///< replaced by a newer one before being taken
  std::uint64_t waiting = 0;     ///< 0 or 1, not taken yet
  double produced_hz = 0;        ///< recent
  double produce_ms_median = 0;  ///< recent time to solve or read one field and its contacts
  double produce_ms_worst = 0;
  double behind_ms = 0;  ///< delay of the play head
};

/// A copy of the play head's state.
struct PlayerState {
  std::uint64_t frame = 0;
  std::uint64_t frames = 0;
  bool playing = false;
  bool loops = true;
  bool follows = false;
  double speed = 1;
  double rate_hz = 0;
};

/// Produces fields in its own thread at the pace of the play head, and never waits for the display:
/// a newer field replaces one that was not taken. Produces the first frame at once; playing starts
/// with play(). Thread safe.
///
/// While following, checks the source for new frames ten times a second. One field waits and one is
/// in production, so the display may hold FieldProducer::kMostShown - 2.
class Player {
 public:
  explicit Player(std::unique_ptr<FieldProducer> producer);
  ~Player();  ///< waits for the field in production; taken fields stay valid
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// Properties at construction; state().frames is the current number of frames.
  [[nodiscard]] const SourceInfo& info() const;

  void play();
  void pause();
  void seek(std::uint64_t frame);
  void step(std::int64_t frames);
  void set_speed(double speed);
  void set_rate(double rate_hz);
  void set_loop(bool loop);
  void set_follow(bool follow);
  /// Switches contacts of fields on or off; on, the current frame is produced again.
  void set_contacts(bool wanted);

  [[nodiscard]] PlayerState state() const;
  [[nodiscard]] PlayerStatistics statistics() const;

  /// Returns the newest field if it was not taken before. After the last field rethrows, once, the
  /// exception that ended the thread.
  [[nodiscard]] std::optional<ShownField> take();

  /// Calls `wake` from the player's thread for each new field and for an error that ends the
  /// thread. `wake` may call all members but this one. The previous `wake` is not called after
  /// return.
  void on_new_field(std::function<void()> wake);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield::viewer
