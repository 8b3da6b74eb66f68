#pragma once

#include "bench/baselines/bare_solve.h"

#ifdef __x86_64__
namespace pillarfield::bench {

/// For processors with AVX2.
void solve_rows_avx2_cached(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                            std::uint32_t last, const ForcePlanes& to);
void solve_rows_avx2_streaming(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                               std::uint32_t last, const ForcePlanes& to);

}  // namespace pillarfield::bench
#endif
