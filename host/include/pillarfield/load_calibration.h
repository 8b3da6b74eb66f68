#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Frames in which bodies that stand still press the skin with a known normal force in all.
struct KnownLoad {
  const FrameStatistics& frames;
  double load_n;
};

/// How readings and load belong together.
enum class LoadModel : std::uint8_t {
  linear,  ///< in proportion
  power,   ///< by a PowerLaw; needs two different loads
};

/// How one load came out.
struct LoadResidual {
  double load_n = 0;
  double solved_n = 0;          ///< total normal force by the new calibration
  double ambiguous_share = 0;   ///< of solved_n, from pillars whose force is ambiguous
  std::uint64_t saturated = 0;  ///< pillars with a saturated sensel, whose force is too small
};

/// What known loads told.
struct LoadResult {
  SkinCalibration calibration;
  std::vector<LoadResidual> loads;  ///< as given
  double misfit = 0;                ///< relative root mean square of solved − load
  /// The counts per newton if the ambiguous pillars had the least, or the most, of their segments.
  double least_counts_per_newton = 0;
  double most_counts_per_newton = 0;
};

/// Fits the counts per newton, and for LoadModel::power the exponent, so that the normal forces the
/// solver finds add up to the known loads. The frames of a load are averaged first. A power law
/// that `before` has is replaced, or dropped for LoadModel::linear; what else it knows is kept.
/// Formulas and limits: docs/calibration.md. Throws Error where a frame shows no contact or the
/// loads do not tell.
[[nodiscard]] LoadResult calibrate_load(const SkinCalibration& before,
                                        std::span<const KnownLoad> loads, LoadModel model);

}  // namespace pillarfield
