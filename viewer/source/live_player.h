#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "viewer/source/live_control.h"
#include "viewer/source/player.h"

namespace pillarfield::viewer {

struct LiveOptions {
  ProducerOptions producer = {};                     ///< with the constants of the skin
  std::filesystem::path calibration = {};            ///< a file; empty: none
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
