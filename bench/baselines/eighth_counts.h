#pragma once

#include <algorithm>
#include <cmath>

#include "bench/baselines/bare_solve.h"

namespace pillarfield::bench {

/// The constants of a bare solve in whole numbers, forces being in eighths of a count.
struct EighthCounts {
  explicit EighthCounts(const BareSolve& solve)
      : threshold(static_cast<short>(solve.threshold)),
        doubt(static_cast<short>(std::floor(std::max(-solve.doubt, -2000.0F)))),
        shear_scale(solve.shear_scale / 8),
        normal_scale(solve.normal_scale / 8) {}

  short threshold;     ///< counts
  short doubt;         ///< counts: whole ones above it are above -doubt of the solve
  float shear_scale;   ///< N per eighth of a count
  float normal_scale;  ///< N per eighth of a count
};

}  // namespace pillarfield::bench
