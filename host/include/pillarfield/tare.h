#pragma once

#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

struct TareOptions {
  double threshold_factor = 4;  ///< see set_threshold
  bool preloaded = false;       ///< a patch that reads far above its fellows is meant to be so
};

/// What the unloaded skin told.
struct TareResult {
  SkinCalibration calibration;
  std::vector<SenselFinding> findings;  ///< all of them masked
  double tare_counts = 0;               ///< median of the good sensels
  double noise_counts = 0;              ///< the same
};

/// The fewest frames a tare is taken from: ten give the noise to about a quarter.
inline constexpr std::uint32_t kLeastTareFrames = 10;

/// Takes the tare (mean) and the noise (standard deviation) of each sensel from frames of the
/// unloaded skin, makes the threshold, and masks sensels that cannot be right. What else `before`
/// knows is kept. Formulas and limits: docs/calibration.md. Throws Error where the frames are too
/// few, of another skin, or show that something touches it.
[[nodiscard]] TareResult take_tare(const SkinCalibration& before, const FrameStatistics& unloaded,
                                   const TareOptions& options);

}  // namespace pillarfield
