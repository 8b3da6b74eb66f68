#pragma once

#include "bench/baselines/bare_solve.h"

namespace pillarfield::bench {

/// The bare direct solve by hand for one processor: 32 pillars at a time with AVX-512, 16 with
/// AVX2, whichever the processor has.
///
/// Readings are whole numbers, and with a threshold that is one too, all of the solve but the last
/// product is exact in 16-bit integers of eighths of a count: the result has the bits of the
/// kernels, which compute in single precision.
struct Vectorised {
  const char* instructions = nullptr;  ///< "AVX-512", "AVX2", or null: this processor has neither
  SolveRows cached = nullptr;
  SolveRows streaming = nullptr;  ///< with stores past the caches
};
Vectorised vectorised();

/// Throws Error unless the threshold is a whole number of at most 255 counts.
void require_whole_threshold(const BareSolve& solve);

}  // namespace pillarfield::bench
