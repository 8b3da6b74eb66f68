#pragma once

#include <cstdint>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// Constants of the bare direct solve of uint8 frames, in single precision.
struct BareSolve {
  float threshold = 0;     ///< counts
  float margin = 0;        ///< counts
  float shear_scale = 0;   ///< N per count
  float normal_scale = 0;  ///< N per count
};

/// Throws Error where the plan has another layout, type, estimator, stage, result or segment point.
BareSolve bare_solve(const SolverPlan& plan);

/// Result planes [pillar rows, pillar cols].
struct ForcePlanes {
  float* shear_x;
  float* shear_y;
  float* normal;
  std::uint8_t* status;
};

/// The planes from a pillar on.
inline ForcePlanes advanced(const ForcePlanes& planes, std::size_t pillars) {
  return {planes.shear_x + pillars, planes.shear_y + pillars, planes.normal + pillars,
          planes.status + pillars};
}

/// Solves the rows of pillars from `first` to before `last`.
using SolveRows = void (*)(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                           std::uint32_t last, const ForcePlanes& to);

/// kernels/pillar as a C++ loop over pillars, compiled at -O3 for the build machine's processor.
void solve_rows_plainly(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                        std::uint32_t last, const ForcePlanes& to);

}  // namespace pillarfield::bench
