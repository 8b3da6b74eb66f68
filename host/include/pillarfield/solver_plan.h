#pragma once

#include <optional>

#include "pillarfield/calibration.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// What is computed, and from which sensor. Each member that is set or not empty adds its
/// stage to the kernel; what is not named costs nothing.
struct SolverPlan {
  Skin skin;
  SenselType sensel_type = SenselType::u8;
  Calibration calibration;
  /// Largest parity residual, and largest surplus of a lifted sensel, that the status byte passes
  /// as consistent, in counts; unset: not tested.
  std::optional<double> parity_tolerance_counts;
  bool angles = false;  ///< also magnitude, theta and phi
};

}  // namespace pillarfield
