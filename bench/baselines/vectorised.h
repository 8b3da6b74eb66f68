#pragma once

#include <vector>

#include "bench/baselines/bare_solve.h"

namespace pillarfield::bench {

/// The bare direct solve in the vector instructions of this processor, by Highway: 32 pillars at a
/// time with AVX-512, 16 with AVX2; the plain loop where there are no vectors.
///
/// Readings are whole numbers, and with a threshold that is one too, all of the solve but the last
/// product is exact in 16-bit integers of eighths of a count: the result has the bits of the
/// kernels, which compute in single precision.
struct Vectorised {
  const char* instructions;  ///< as Highway names them: "AVX3" is AVX-512
  SolveRows cached;
  SolveRows streaming;  ///< with stores past the caches
};

/// One for each set of instructions that this processor has, the best first.
std::vector<Vectorised> vectorised();

/// Throws Error unless the threshold is a whole number of at most 255 counts.
void require_whole_threshold(const BareSolve& solve);

}  // namespace pillarfield::bench
