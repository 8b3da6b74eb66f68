#pragma once

#include "bench/baselines/bare_solve.h"

namespace pillarfield::bench {

/// kernels/pillar as C++, one pillar after the other, as the compiler makes it at -O3 for this very
/// processor.
void solve_rows_plainly(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                        std::uint32_t last, const ForcePlanes& to);

}  // namespace pillarfield::bench
