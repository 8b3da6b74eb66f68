#pragma once

#include <optional>
#include <vector>

#include "calibration/response_fit.h"

namespace pillarfield {

/// Residuals under a pressure that a fit left out.
struct HeldOutLevel {
  double force_n = 0;      ///< mean force on the sensels
  double mean_square = 0;  ///< of the fitted force minus the force, N²
};

/// A fit of `kind` to the presses; unset if the sensels share no response (level_readings()).
[[nodiscard]] std::optional<ResponseFit> fit_of(ResponseModel kind,
                                                std::span<const UniformPress> presses,
                                                const Calibration& planes,
                                                const std::vector<std::uint8_t>& mask);

/// Leaves out each pressure but the lowest and the highest, fits the others, and compares the
/// forces of the good sensels. Empty with fewer than three pressures or without a fit.
[[nodiscard]] std::vector<HeldOutLevel> hold_out(ResponseModel kind, const ResponseFit& all,
                                                 const std::vector<std::uint8_t>& mask);

/// Root mean square of the residuals over that of the forces; unset without levels.
[[nodiscard]] std::optional<double> relative_residual(const std::vector<HeldOutLevel>& levels);

/// The standard deviation root(offset² + (relative V)²) of V = k · force that is nearest, in
/// relative terms, to the residuals; only relative with one level. Unset without levels.
[[nodiscard]] std::optional<ResidualError> residual_error(const std::vector<HeldOutLevel>& levels,
                                                          double counts_per_newton);

}  // namespace pillarfield
