// The search for a touch in frames that should be of an untouched skin.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/tare.h"

namespace pillarfield {

/// A change of readings in time that noise, drift and single spikes do not explain.
struct MovingTouch {
  std::size_t sensel = 0;  ///< farthest from its level
  bool covers_all = false;
  double counts = 0;      ///< distance of that sensel, or of the array
  std::size_t first = 0;  ///< kept frame
  std::size_t last = 0;
};

/// Frames of the unloaded skin, examined.
struct ExaminedFrames {
  std::optional<MovingTouch> touch;
  FrameStatistics still;       ///< of the kept frames, without spikes
  std::vector<double> noises;  ///< standard deviations from frame to frame
  std::size_t spikes = 0;
};

/// Looks for neighbouring sensels that leave their level together, for sensels that leave it for
/// long, and for a jump of the whole array; about 30 ns a reading. Levels are medians and linear
/// drift of each sensel, noise that of five frames, as of most of the time.
[[nodiscard]] ExaminedFrames examine_frames(const TareFrames& unloaded,
                                            std::span<const std::uint8_t> mask);

}  // namespace pillarfield
