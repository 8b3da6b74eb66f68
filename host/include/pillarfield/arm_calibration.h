#pragma once

#include <cstdint>
#include <span>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// The result of calibrate_arm().
struct ArmResult {
  SkinCalibration calibration;
  double arm_mm = 0;          ///< of the fit; stored only if `found`
  double standard_error = 0;  ///< of arm_mm, relative
  bool found = false;         ///< arm_mm is significant; otherwise no arm is stored
  double longest_mm = 0;      ///< longest arm that would be significant
  std::uint64_t pillars = 0;  ///< region 1 pillars that were used
  std::uint64_t places = 0;   ///< contacts
  double shear_before_n = 0;  ///< RMS solved shear component of these pillars, N
  double shear_after_n = 0;   ///< what the arm leaves of it
};

/// Fits the arm of off-centre pressure (SensorEffects::arm_mm) to bodies that press straight down:
/// what their region 1 pillars read as shear is the lean of the pressure over the arm. Averages the
/// frames of each file first; each contact in it is a place. Stores no arm if its inverse lies
/// within three standard errors of zero. Replaces the arm of `before`, which must have a tare;
/// everything else of it is kept. Formulas and limits: docs/calibration.md. Throws Error if too few
/// pillars are pressed or if the standard error is above kMostArmError.
[[nodiscard]] ArmResult calibrate_arm(const SkinCalibration& before,
                                      std::span<const FrameStatistics> presses);

/// Largest standard error of an arm, relative.
inline constexpr double kMostArmError = 0.1;

}  // namespace pillarfield
