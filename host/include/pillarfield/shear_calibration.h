#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Frames of the skin under a body at rest with a known total tangential force on the skin.
struct KnownShear {
  const FrameStatistics& frames;
  double shear_x_n = 0;  ///< + right
  double shear_y_n = 0;  ///< + up
  /// Total normal force. If set, the solved shear is scaled by it over the solved normal force, so
  /// that errors of k and creep, which both share, cancel.
  std::optional<double> normal_n = {};
};

/// The sums of one tangential load.
struct ShearSum {
  double shear_x_n = 0;  ///< solved with the new coefficient
  double shear_y_n = 0;
  double ambiguous_share = 0;  ///< fraction of the normal force on ambiguous pillars
};

/// The result of calibrate_shear().
struct ShearResult {
  SkinCalibration calibration;
  ShearCoefficient coefficient;     ///< an axis without a load has that of the other one
  ShearCoefficient standard_error;  ///< from noise, residual error and the scatter of the loads
  std::vector<ShearSum> loads;      ///< in the order given
};

/// Fits the shear coefficients c_x and c_y so that the solved shear adds up to the known loads, by
/// least squares. Averages the frames of a load first. Stores no coefficient if both lie within two
/// standard errors of 1. `before` must have the counts per newton; everything else of it is kept.
/// Formulas and limits: docs/calibration.md. Throws Error if the frames of a load show no contact,
/// if all loads are zero or if a coefficient is out of range.
[[nodiscard]] ShearResult calibrate_shear(const SkinCalibration& before,
                                          std::span<const KnownShear> loads);

}  // namespace pillarfield
