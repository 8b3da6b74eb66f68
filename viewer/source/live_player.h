#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "pillarfield/result_stream.h"
#include "viewer/source/plane_block.h"
#include "viewer/source/player.h"

namespace pillarfield::viewer {

/// Times of the fields of a live source in seconds since a start, which rise from field to field.
class FieldClock {
 public:
  /// Follows the sensor's clock from the first frame on, which evens out delays on the way; where
  /// it stands still, jumps, or leaves the time of arrival, takes that.
  double time_s(double sensor_s, std::chrono::nanoseconds arrived);

 private:
  std::chrono::nanoseconds start_ = std::chrono::steady_clock::now().time_since_epoch();
  double last_s_ = -1;              ///< of the field before
  std::optional<double> offset_s_;  ///< that time less the sensor's
};

/// A live source on display: a thread of the derived class measures every field, and produces
/// fields for `newest_` as they are wanted, and none while paused.
class LiveView : public Player, public LiveControl {
 public:
  explicit LiveView(std::shared_ptr<Curves> curves) : curves_(std::move(curves)) {}

  void play() override { paused_ = false; }
  void pause() override { paused_ = true; }
  void set_contacts(bool wanted) override { wants_contacts_ = wanted; }
  [[nodiscard]] LiveControl* live() override { return this; }

 protected:
  [[nodiscard]] PlayerState state_after(std::uint64_t frames, double rate_hz) const;

  /// Adds a field to curves and statistics.
  void measure(const ShownField& field);

  std::atomic<bool> paused_ = false;
  std::atomic<bool> wants_contacts_ = false;
  FieldClock clock_;  ///< of the thread

 private:
  const std::shared_ptr<Curves> curves_;
};

/// Shows the results that another program writes into a ring, as they come, with the contacts that
/// it found. The time of a field is the sensor's, counted from the start of the player.
[[nodiscard]] std::unique_ptr<Player> play_results(std::unique_ptr<ResultStream> stream,
                                                   const std::string& name,
                                                   std::shared_ptr<Curves> curves);

struct LiveOptions {
  ProducerOptions producer = {};                     ///< with the constants of the skin
  std::function<bool()> stop = {};                   ///< gives up waiting for the first frame
  std::function<void(const std::string&)> say = {};  ///< as LiveSourceOptions has it
};

/// A plan for display whose tare can be measured anew.
[[nodiscard]] SolverPlan live_plan(const FrameStream& stream, const LiveOptions& options);

struct OpenedSensor {
  std::unique_ptr<Player> player;
  std::shared_ptr<Curves> curves;  ///< of the last minutes
};

/// Solves every frame of a sensor as it arrives, by a Pipeline in a thread of its own, and hands
/// the newest to the display; the stream counts frames for which the program is late. The time of a
/// field is the sensor's, counted from the start of the player.
[[nodiscard]] OpenedSensor play_sensor(std::unique_ptr<FrameStream> stream, const std::string& name,
                                       const LiveOptions& options);

/// Opens a live source and waits for its first frame, or for the ring if it is one of results;
/// null if LiveOptions::stop gave up. Throws Error where the source or the calibration cannot be
/// opened, or results are to be calibrated.
[[nodiscard]] OpenedSensor open_sensor(const std::string& source, const LiveOptions& options);

}  // namespace pillarfield::viewer
