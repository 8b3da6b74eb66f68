#pragma once

#include <optional>
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

/// The relation of readings and uniform pressure.
enum class ResponseModel : std::uint8_t {
  linear,  ///< a straight line for each sensel, with its own dead zone
  curve,   ///< a ResponseCurve and a dead zone that all sensels share, and a gain for each
};

/// Options of equilibrate().
struct EquilibrationOptions {
  /// Unset: the curve if it leaves less than 0.8 of the linear residual on held-out pressures,
  /// which takes three pressures.
  std::optional<ResponseModel> model = {};
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
  /// Relative RMS residual of the fits of the model; 0 with fewer than three pressures.
  double nonlinearity = 0;
  ResponseModel model = ResponseModel::linear;
  /// Relative RMS residual on each pressure between the lowest and the highest, left out of the
  /// fit; unset with fewer than three pressures, or where the sensels share no response.
  std::optional<double> held_out_linear;
  std::optional<double> held_out_curve;
};

/// Least number of frames per press.
inline constexpr std::uint32_t kLeastPressFrames = 5;

/// Fits the gain of each sensel (mean 1), the counts per newton and, with at least two pressures,
/// the dead zones, from raw − tare = g·f(max(0, V − z)) with V = k · pressure · area of a pillar
/// and f linear or the inverse of a response curve that all sensels share. Known effects of
/// neighbours of `before` count. Masks sensels that respond not at all or unlike the others.
/// Replaces the response curve and the residual error; a curve replaces the power law. `before`
/// must have a tare; everything else of it is kept. Formulas and limits: docs/calibration.md.
/// Throws Error if the pressure is not uniform, too low or too high.
[[nodiscard]] EquilibrationResult equilibrate(const SkinCalibration& before,
                                              std::span<const UniformPress> presses,
                                              const EquilibrationOptions& options);

}  // namespace pillarfield
