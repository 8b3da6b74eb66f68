#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Sensels that share wires.
struct WireTile {
  std::uint32_t rows = 64;  ///< 2..1024
  std::uint32_t cols = 64;
};

/// The result of calibrate_wires().
struct WireResult {
  SkinCalibration calibration;  ///< blank but for the wires, and the mask of `before`
  WireCrosstalk wires;
  WireCrosstalk standard_error;
  bool found = false;       ///< whether the row's or the column's exceeds three standard errors
  std::size_t sensels = 0;  ///< under the body at rest
  /// Fraction of the tares caused by conductance, near 0 or 1: how far the readings of unloaded
  /// sensels follow the loss of their wires.
  double conducting_share = 0;
  /// Origin of the tares by `conducting_share`; unset where tares or the loss are within the noise.
  std::optional<TareOrigin> tares_shown;
  /// RMS change of their readings under the other loads, as a fraction: before and after.
  double residual_before = 0;
  double residual_after = 0;
};

/// Fits the resistances of the wires. Under all of `presses` the same body rests at the same place;
/// in the first one it is alone, in the others another body presses elsewhere, in some in its rows
/// and in some in its columns. What its sensels read then changes only through the wires. Tares,
/// gains and noise of `before` were measured through the wires and are removed: measure them again.
/// `tares` says how tares arise; unset: as the readings of unloaded sensels show, or else by
/// conductance. Formulas and limits: docs/calibration.md. Throws Error without a body that rests
/// alone, or if the other loads change nothing that tells rows from columns.
[[nodiscard]] WireResult calibrate_wires(const SkinCalibration& before,
                                         std::span<const FrameStatistics> presses,
                                         const WireTile& tile,
                                         std::optional<TareOrigin> tares = std::nullopt);

}  // namespace pillarfield
