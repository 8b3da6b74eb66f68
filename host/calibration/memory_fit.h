#pragma once

#include <optional>
#include <vector>

#include "pillarfield/memory_calibration.h"

namespace pillarfield {

/// A fit of c(reading) = U + Σ plays(U) + Σ creep(U), U = max(0, load − dead zone), with c
/// piecewise linear and increasing.
struct MemoryFit {
  double squares = 0;  ///< sum of squared residuals
  double dead_zone = 0;
  std::vector<double> slopes;  ///< of c, between the ends given
  SenselMemory memory;         ///< weights above zero
};

/// What fit_memory() fits.
struct MemoryModelling {
  std::vector<double> ends;         ///< of the pieces of c: readings, increasing
  std::optional<double> dead_zone;  ///< unset: fitted
  bool with_memory = true;
};

/// Fits c, the dead zone and plays of fixed widths and two creep times of a grid, all weights by
/// non-negative least squares.
[[nodiscard]] MemoryFit fit_memory(const std::vector<MemoryFinder::Sample>& samples,
                                   const MemoryModelling& model);

/// c at a reading.
[[nodiscard]] double value_at(const MemoryFit& fit, const std::vector<double>& ends,
                              double reading);

}  // namespace pillarfield
