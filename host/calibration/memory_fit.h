#pragma once

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

/// Fits c, with pieces that end at `ends` (readings, increasing), the dead zone and, `with_memory`,
/// plays of fixed widths and two creep times of a grid, all weights by non-negative least squares.
[[nodiscard]] MemoryFit fit_memory(const std::vector<MemoryFinder::Sample>& samples,
                                   const std::vector<double>& ends, bool with_memory);

/// c at the end of each piece.
[[nodiscard]] std::vector<double> values_at_ends(const MemoryFit& fit,
                                                 const std::vector<double>& ends);

}  // namespace pillarfield
