#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "viewer/source/curves.h"
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

class LiveControl;

/// Produces fields in its own thread, and never waits for the display: a newer field replaces one
/// that was not taken. Thread safe. FilePlayer plays a file or a scene, LivePlayer a
/// sensor, ResultPlayer the results of another program.
class Player {
 public:
  Player() = default;
  virtual ~Player() = default;  ///< taken fields stay valid
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// Properties at construction; state().frames is the current number of frames, 0 of a sensor.
  [[nodiscard]] virtual const SourceInfo& info() const = 0;

  virtual void play() = 0;
  virtual void pause() = 0;  ///< the picture of a sensor freezes, not the sensor
  // Without effect on a sensor.
  virtual void seek(std::uint64_t frame) = 0;
  virtual void step(std::int64_t frames) = 0;
  virtual void set_speed(double speed) = 0;
  virtual void set_rate(double rate_hz) = 0;
  virtual void set_loop(bool loop) = 0;
  virtual void set_follow(bool follow) = 0;
  /// Switches contacts of fields on or off; on, the current frame is produced again.
  virtual void set_contacts(bool wanted) = 0;
  /// Switches ShownField::peak on, beginning with the current frame, or off.
  virtual void set_peak(bool wanted) = 0;

  [[nodiscard]] virtual PlayerState state() const = 0;
  [[nodiscard]] virtual PlayerStatistics statistics() const = 0;

  /// Returns the newest field if it was not taken before. After the last field rethrows, once, the
  /// exception that ended the thread.
  [[nodiscard]] virtual std::optional<ShownField> take() = 0;

  /// Calls `wake` from the player's thread for each new field and for an error that ends the
  /// thread. `wake` may call all members but this one. The previous `wake` is not called after
  /// return.
  virtual void on_new_field(std::function<void()> wake) = 0;

  /// What a sensor can do besides; null for a file.
  [[nodiscard]] virtual LiveControl* live() { return nullptr; }
};

/// Produces fields at the pace of the play head. Produces the first frame at once; playing starts
/// with play().
///
/// While following, checks the source for new frames ten times a second. One field waits and one is
/// in production, so the display may hold FieldProducer::kMostShown - 2.
class FilePlayer final : public Player {
 public:
  explicit FilePlayer(std::unique_ptr<FieldProducer> producer);
  ~FilePlayer() override;  ///< waits for the field in production

  [[nodiscard]] const SourceInfo& info() const override;
  void play() override;
  void pause() override;
  void seek(std::uint64_t frame) override;
  void step(std::int64_t frames) override;
  void set_speed(double speed) override;
  void set_rate(double rate_hz) override;
  void set_loop(bool loop) override;
  void set_follow(bool follow) override;
  void set_contacts(bool wanted) override;
  void set_peak(bool wanted) override;
  [[nodiscard]] PlayerState state() const override;
  [[nodiscard]] PlayerStatistics statistics() const override;
  [[nodiscard]] std::optional<ShownField> take() override;
  void on_new_field(std::function<void()> wake) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield::viewer
