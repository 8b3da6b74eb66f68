#pragma once

#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Readings after tare, gain and response curve or power law, [rows, cols], counts: what sensels
/// read whose neighbours, memory and dead zone are not corrected. NaN for missing, masked and
/// saturated sensels.
[[nodiscard]] std::vector<float> linear_readings(const SkinCalibration& calibration,
                                                 const Skin& skin, const FrameView& frame);

/// Mean noise of a reading after the gain, counts. Throws Error if the calibration has none.
[[nodiscard]] double mean_noise(const SkinCalibration& calibration);

}  // namespace pillarfield
