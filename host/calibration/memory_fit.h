#pragma once

#include <optional>
#include <vector>

#include "pillarfield/calibration_steps.h"

namespace pillarfield {

/// A fit of c(reading) = U + Σ plays(U) + Σ creep(U) + remainder, U = max(0, load − dead zone),
/// with c piecewise linear and increasing. The remainder is there from the first load of a
/// recording on.
struct MemoryFit {
  double squares = 0;  ///< sum of squared residuals
  double dead_zone = 0;
  std::vector<double> slopes;  ///< of c, between the ends given
  SenselMemory memory;         ///< weights above zero
  double remainder = 0;        ///< counts, not negative
};

/// A straight piece of c, from the end of the one before, or zero, on.
struct CurveStretch {
  double end;        ///< counts
  double slope = 1;  ///< of the curve that c follows there
};

/// Model that fit_memory() fits. A piece that few frames hold takes its slope, times that of the
/// curve that c follows, from its neighbours.
struct MemoryModelling {
  std::vector<CurveStretch> pieces;  ///< of c
  std::optional<double> dead_zone;   ///< unset: fitted
  bool with_memory = true;
  bool with_remainder = false;
};

/// Fits c, the dead zone and plays of fixed widths and two creep times of a grid, all weights by
/// non-negative least squares.
[[nodiscard]] MemoryFit fit_memory(const std::vector<MemoryFinder::Sample>& samples,
                                   const MemoryModelling& model);

/// c at a reading.
[[nodiscard]] double value_at(const MemoryFit& fit, const std::vector<CurveStretch>& pieces,
                              double reading);

}  // namespace pillarfield
