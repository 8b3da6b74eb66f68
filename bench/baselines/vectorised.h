#pragma once

#include <vector>

#include "bench/baselines/bare_solve.h"

namespace pillarfield::bench {

/// The bare direct solve in vector intrinsics by Highway: 32 pillars at a time with AVX-512, 16
/// with AVX2; the plain loop on a processor without vectors.
///
/// Readings and threshold are whole numbers, so 16-bit integers of eighths of a count are exact up
/// to the last product: the result equals that of the single-precision kernels bit for bit.
struct Vectorised {
  const char* instructions;  ///< Highway's name: "AVX3" is AVX-512
  SolveRows cached;
  SolveRows streaming;  ///< with nontemporal stores
};

/// One for each instruction set of this processor, the best first.
std::vector<Vectorised> vectorised();

/// Throws Error unless the threshold is a whole number of at most 255 counts.
void require_whole_threshold(const BareSolve& solve);

}  // namespace pillarfield::bench
