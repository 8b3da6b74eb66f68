#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "pillarfield/live.h"

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

}  // namespace pillarfield::viewer
