#pragma once

#include <string_view>

#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Largest fraction of the pillars of an untouched skin that may have a status.
inline constexpr double kMostUntouched = 1e-3;

/// The fraction, in [0, 1], of the pillars of the untouched skin that solve_on_host() gives a
/// status, as if touched: of frames of the calibration's tare and noise, 20,000 pillars or more. 0
/// without noise or a threshold.
[[nodiscard]] double untouched_share(const SkinCalibration& calibration);

/// Throws Error, naming `step`, if the step, from `before` to `after`, brings untouched_share()
/// above kMostUntouched.
void require_untouched_idle(const SkinCalibration& before, const SkinCalibration& after,
                            std::string_view step);

}  // namespace pillarfield
