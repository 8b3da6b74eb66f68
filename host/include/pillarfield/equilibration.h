#pragma once

#include <span>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Frames under a uniform pressure without shear.
struct UniformPress {
  const FrameStatistics& frames;
  double pressure_kpa;
};

/// Options of equilibrate().
struct EquilibrationOptions {
  /// Largest accepted relative standard deviation of the pressure from pillar to pillar.
  double most_unevenness = 0.1;
};

/// The result of equilibrate().
struct EquilibrationResult {
  SkinCalibration calibration;
  std::vector<SenselFinding> findings;  ///< all masked
  std::size_t levels = 0;               ///< number of different pressures
  double gain_spread = 0;               ///< relative standard deviation of gains, good sensels
  double dead_zone_counts = 0;          ///< median of the good sensels
  /// Relative standard deviation from pillar to pillar, of the pressure or of gains that neighbours
  /// share, beyond what the spread of single sensels explains.
  double unevenness = 0;
  /// Tangential over normal force of the whole press. It is the relative error of the gains.
  double shear = 0;
  /// Relative RMS residual of the straight-line fits; 0 with fewer than three pressures.
  double nonlinearity = 0;
};

/// Least number of frames per press.
inline constexpr std::uint32_t kLeastPressFrames = 5;

/// Fits the gain of each sensel (mean 1), the counts per newton and, with at least two pressures,
/// the dead zones, from raw − tare = g·max(0, V − z) with V = k · pressure · area of a pillar.
/// Masks sensels that respond not at all or unlike the others. `before` must have a tare;
/// everything else of it is kept. Formulas and limits: docs/calibration.md. Throws Error if the
/// pressure is not uniform, too low or too high.
[[nodiscard]] EquilibrationResult equilibrate(const SkinCalibration& before,
                                              std::span<const UniformPress> presses,
                                              const EquilibrationOptions& options);

}  // namespace pillarfield
