#pragma once

#include <span>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Frames under one uniform pressure, without shear.
struct UniformPress {
  const FrameStatistics& frames;
  double pressure_kpa;
};

struct EquilibrationOptions {
  /// The largest relative standard deviation of the pressure from pillar to pillar that passes.
  double most_unevenness = 0.1;
};

/// What uniform pressure told.
struct EquilibrationResult {
  SkinCalibration calibration;
  std::vector<SenselFinding> findings;  ///< all of them masked
  std::size_t levels = 0;               ///< different pressures
  double gain_spread = 0;               ///< relative standard deviation of the good sensels' gains
  double dead_zone_counts = 0;          ///< median of the good sensels
  /// Relative standard deviation, from pillar to pillar, that the sensels' own spread does not
  /// explain: of the pressure, or of gains that neighbours share.
  double unevenness = 0;
  /// Tangential over normal force of the whole press. Gains made under shear are wrong by it.
  double shear = 0;
  /// Relative root mean square of what the straight lines leave; 0 for less than three pressures.
  double nonlinearity = 0;
};

/// The fewest frames of a press.
inline constexpr std::uint32_t kLeastPressFrames = 5;

/// Makes the gain of each sensel (mean 1), the counts per newton, and with two pressures or more
/// the dead zone, from raw − tare = g·max(0, V − z) with V = k · pressure · area of a pillar.
/// Sensels that do not answer, or not as their fellows do, are masked. What else `before` knows is
/// kept; its tare is needed. Formulas and limits: docs/calibration.md. Throws Error where the
/// pressure is not uniform, too low, or too high.
[[nodiscard]] EquilibrationResult equilibrate(const SkinCalibration& before,
                                              std::span<const UniformPress> presses,
                                              const EquilibrationOptions& options);

}  // namespace pillarfield
