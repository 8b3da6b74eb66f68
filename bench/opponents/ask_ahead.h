#pragma once

#include <cstddef>
#include <cstdint>

#include "bench/opponents/bare_solve.h"

namespace pillarfield::bench {

/// For a loop that solves `pillars` at a time: asks for what it reads 4096 bytes later, which the
/// processor does not see coming at the ends of rows, and, unless stores go past the caches, for
/// the lines that it writes 256 pillars later. Found by trying.
template <std::ptrdiff_t pillars, bool streaming>
inline void ask_ahead(const std::uint8_t* top, const std::uint8_t* bottom, const ForcePlanes& to) {
  constexpr std::ptrdiff_t kBytesAhead = 4096;
  constexpr std::ptrdiff_t kPillarsAhead = 256;
  for (std::ptrdiff_t i = kBytesAhead; i < kBytesAhead + 2 * pillars; i += 64) {
    __builtin_prefetch(top + i);
    __builtin_prefetch(bottom + i);
  }
  if (streaming) return;
  for (std::ptrdiff_t i = kPillarsAhead; i < kPillarsAhead + pillars; i += 16) {
    __builtin_prefetch(to.shear_x + i, 1);
    __builtin_prefetch(to.shear_y + i, 1);
    __builtin_prefetch(to.normal + i, 1);
  }
  __builtin_prefetch(to.status + kPillarsAhead, 1);
}

}  // namespace pillarfield::bench
