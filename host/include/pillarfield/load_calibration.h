#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Frames of the skin under bodies at rest with a known total normal force.
struct KnownLoad {
  const FrameStatistics& frames;
  double load_n;
};

/// The relation of readings and load.
enum class LoadModel : std::uint8_t {
  linear,  ///< proportional
  power,   ///< a PowerLaw; needs two different loads
};

/// The residual of one load.
struct LoadResidual {
  double load_n = 0;
  double solved_n = 0;          ///< total normal force with the new calibration
  double ambiguous_share = 0;   ///< fraction of solved_n on ambiguous pillars
  std::uint64_t saturated = 0;  ///< pillars with a saturated sensel; their force is too small
};

/// The result of calibrate_load().
struct LoadResult {
  SkinCalibration calibration;
  std::vector<LoadResidual> loads;  ///< in the order given
  double misfit = 0;                ///< relative RMS of solved − load
  /// Counts per newton if all ambiguous pillars had the lower, or the upper, end of their segments.
  double least_counts_per_newton = 0;
  double most_counts_per_newton = 0;
};

/// Fits the counts per newton and, for LoadModel::power, the exponent, so that the solved normal
/// forces add up to the known loads. Averages the frames of a load first. Replaces the power law of
/// `before`, or removes it for LoadModel::linear, raises the residual error to what several loads
/// leave, and keeps everything else. Formulas and limits:
/// docs/calibration.md. Throws Error if the frames of a load show no contact or the loads do not
/// determine the fit.
[[nodiscard]] LoadResult calibrate_load(const SkinCalibration& before,
                                        std::span<const KnownLoad> loads, LoadModel model);

}  // namespace pillarfield
