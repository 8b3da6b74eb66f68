#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "pillarfield/live.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/playback.h"
#include "viewer/source/recent_times.h"

namespace pillarfield::viewer {

/// Counts since construction, and the rate over about the last second.
/// produced = taken + not_shown + waiting.
struct PlayerStatistics {
  std::uint64_t produced = 0;   ///< fields solved or read
  std::uint64_t taken = 0;      ///< passed to the display
  std::uint64_t not_shown = 0;  ///< replaced by a newer one before being taken
  std::uint64_t waiting = 0;    ///< 0 or 1, not taken yet
  double produced_hz = 0;       ///< recent
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

/// Hands the newest field of a thread to the display, and counts those that it did not take.
/// Thread safe.
class NewestField {
 public:
  void count();  ///< counts a field
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
  std::mutex waking_;  ///< guards `wake_`, also while it runs; never held together with `mutex_`
  std::function<void()> wake_;
};

/// After this time without a frame a sensor counts as silent.
inline constexpr double kSilentSeconds = 1;

/// The state of a sensor.
struct LiveStatus {
  HealthReport health;
  bool ended = false;  ///< no frame will follow
  bool taring = false;
  std::string recording;             ///< file; empty: none
  LiveSinkStatistics recorded = {};  ///< of that file
  std::string message;               ///< about the last tare or recording
  bool failed = false;               ///< it says that this failed
  std::uint64_t messages = 0;        ///< how many there were
  std::uint64_t tares = 0;           ///< of these, that a tare was taken
};

/// "12 frames, 3 dropped, failed: the disk is full".
[[nodiscard]] std::string recorded_words(const LiveSinkStatistics& recorded);

/// Actions of a user on a sensor. Results of another program have no tare and no raw frames:
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
  [[nodiscard]] virtual LiveStatus status() = 0;
};

/// Produces fields in its own thread, and never waits for the display: a newer field replaces one
/// that was not taken. Thread safe.
class Player {
 public:
  Player() = default;
  virtual ~Player() = default;  ///< taken fields stay valid
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;

  /// Properties at construction; state().frames is the current number of frames, 0 of a sensor.
  [[nodiscard]] virtual const SourceInfo& info() const = 0;
  [[nodiscard]] virtual PlayerState state() const = 0;
  /// Switches contacts of fields on or off; on, the current frame is produced again.
  virtual void set_contacts(bool wanted) = 0;

  virtual void play() { move(&Playback::play); }
  virtual void pause() {  ///< the picture of a sensor freezes, not the sensor
    move([](Playback& head, Playback::Time) { head.pause(); });
  }
  // As Playback has them; without effect on a sensor.
  void seek(std::uint64_t frame) {
    move([=](Playback& head, Playback::Time now) { head.seek(frame, now); });
  }
  void step(std::int64_t frames) {
    move([=](Playback& head, Playback::Time now) { head.step(frames, now); });
  }
  void set_speed(double speed) {
    move([=](Playback& head, Playback::Time now) { head.set_speed(speed, now); });
  }
  void set_loop(bool loop) {
    move([=](Playback& head, Playback::Time) { head.set_loop(loop); });
  }
  void set_follow(bool follow) {
    move([=](Playback& head, Playback::Time now) { head.set_follow(follow, now); });
  }

  [[nodiscard]] PlayerStatistics statistics() const { return newest_.statistics(); }

  /// Returns the newest field if it was not taken before. After the last field rethrows, once, the
  /// exception that ended the thread.
  [[nodiscard]] std::optional<ShownField> take() { return newest_.take(); }

  /// Calls `wake` from the player's thread for each new field and for an error that ends the
  /// thread. `wake` may call all members but this one. The previous `wake` is not called after
  /// return.
  void on_new_field(std::function<void()> wake) { newest_.on_new_field(std::move(wake)); }

  /// Actions on a sensor; null for a file.
  [[nodiscard]] virtual LiveControl* live() { return nullptr; }

 protected:
  using Move = std::function<void(Playback& head, Playback::Time now)>;
  /// Moves the play head, which a sensor does not have.
  virtual void move(const Move& /*change*/) {}

  NewestField newest_;
};

/// Plays a file or a scene at the pace of a play head. Produces the first frame at once; playing
/// starts with play().
///
/// While following, checks the source for new frames ten times a second. One field waits and one is
/// in production, so the display may hold FieldProducer::kMostShown - 2. The destructor waits for
/// the field in production.
[[nodiscard]] std::unique_ptr<Player> play_file(std::unique_ptr<FieldProducer> producer);

}  // namespace pillarfield::viewer
