#pragma once

#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Options of take_tare().
struct TareOptions {
  double threshold_factor = 4;  ///< see set_threshold()
  bool preloaded = false;  ///< accept an area that reads far above the rest: it is bent or covered
};

/// The result of take_tare().
struct TareResult {
  SkinCalibration calibration;
  std::vector<SenselFinding> findings;  ///< all masked
  double tare_counts = 0;               ///< median of the good sensels
  double noise_counts = 0;              ///< median of the good sensels
};

/// Least number of frames for a tare: ten determine the noise to about a quarter.
inline constexpr std::uint32_t kLeastTareFrames = 10;

/// Measures the tare (mean) and the noise (standard deviation) of each sensel on the unloaded skin,
/// sets the threshold, and masks faulty sensels. Keeps everything else of `before`. Formulas and
/// limits: docs/calibration.md. Throws Error if the frames are too few or of another skin, or
/// something touches the skin.
[[nodiscard]] TareResult take_tare(const SkinCalibration& before, const FrameStatistics& unloaded,
                                   const TareOptions& options);

}  // namespace pillarfield
