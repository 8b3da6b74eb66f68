#include "bench/baselines/vectorised.h"

#include <cmath>

#include "bench/baselines/vectorised_avx2.h"
#include "bench/baselines/vectorised_avx512.h"
#include "pillarfield/error.h"

namespace pillarfield::bench {

Vectorised vectorised() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512vl") != 0) {
    return {"AVX-512", solve_rows_avx512_cached, solve_rows_avx512_streaming};
  }
  if (__builtin_cpu_supports("avx2") != 0) {
    return {"AVX2", solve_rows_avx2_cached, solve_rows_avx2_streaming};
  }
#endif
  return {};
}

void require_whole_threshold(const BareSolve& solve) {
  if (solve.threshold <= 255 && solve.threshold == std::floor(solve.threshold)) return;
  throw Error("opponent", "the threshold is not a whole number of counts up to 255",
              "take one that is");
}

}  // namespace pillarfield::bench
