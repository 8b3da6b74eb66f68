#pragma once

#include "bench/baselines/bare_solve.h"

namespace pillarfield::bench {

/// kernels/pillar as a C++ loop over pillars, compiled at -O3 for the build machine's processor.
void solve_rows_plainly(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                        std::uint32_t last, const ForcePlanes& to);

}  // namespace pillarfield::bench
