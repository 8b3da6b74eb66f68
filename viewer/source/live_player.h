#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "pillarfield/live.h"
#include "viewer/source/player.h"

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

struct LiveOptions {
  ProducerOptions producer = {};
  std::optional<double> counts_per_newton = {};      ///< unset: that of the skin
  std::filesystem::path calibration = {};            ///< a file; empty: none
  std::function<bool()> stop = {};                   ///< gives up waiting for the first frame
  std::function<void(const std::string&)> say = {};  ///< as LiveSourceOptions has it
};

/// Solves every frame of a sensor as it arrives, by a Pipeline in a thread of its own, and hands
/// the newest to the display; the stream counts frames for which the program is late. The time of a
/// field is the sensor's, counted from the start of the player.
class LivePlayer final : public Player, public LiveControl {
 public:
  /// Frames in flight of the processor: two, and the fields that the display holds in place.
  static constexpr int kFramesInFlight = FieldProducer::kMostShown + 2;

  /// `processor` is made for `plan`, with kFramesInFlight slots.
  LivePlayer(std::unique_ptr<FrameStream> stream, const std::string& name, const SolverPlan& plan,
             Processor processor, std::shared_ptr<Curves> curves);
  ~LivePlayer() override;

  [[nodiscard]] const SourceInfo& info() const override;
  void play() override;
  void pause() override;
  void seek(std::uint64_t /*frame*/) override {}
  void step(std::int64_t /*frames*/) override {}
  void set_speed(double /*speed*/) override {}
  void set_rate(double /*rate_hz*/) override {}
  void set_loop(bool /*loop*/) override {}
  void set_follow(bool /*follow*/) override {}
  void set_contacts(bool wanted) override;
  void set_peak(bool wanted) override;
  [[nodiscard]] PlayerState state() const override;
  [[nodiscard]] PlayerStatistics statistics() const override;
  [[nodiscard]] std::optional<ShownField> take() override;
  void on_new_field(std::function<void()> wake) override;
  [[nodiscard]] LiveControl* live() override { return this; }

  void tare() override;
  void record(const std::filesystem::path& path) override;
  void stop_recording() override;
  [[nodiscard]] LiveStatus status() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A plan for display whose tare can be measured anew.
[[nodiscard]] SolverPlan live_plan(const FrameStream& stream, const LiveOptions& options);

struct OpenedSensor {
  std::unique_ptr<Player> player;
  std::shared_ptr<Curves> curves;  ///< of the last minutes
};

/// Opens a live source and waits for its first frame, or for the ring if it is one of results;
/// null if LiveOptions::stop gave up. Throws Error where the source or the calibration cannot be
/// opened, or results are to be calibrated.
[[nodiscard]] OpenedSensor open_sensor(const std::string& source, const LiveOptions& options);

}  // namespace pillarfield::viewer
