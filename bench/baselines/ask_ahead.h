#pragma once

#include <cstddef>
#include <cstdint>

namespace pillarfield::bench {

/// For a loop that solves `pillars` at a time: asks for what it reads 4096 bytes later, which the
/// processor does not see coming at the ends of rows. Found by trying; to ask for what is written
/// did not pay.
template <std::ptrdiff_t pillars>
inline void ask_ahead(const std::uint8_t* top, const std::uint8_t* bottom) {
  constexpr std::ptrdiff_t kBytesAhead = 4096;
  for (std::ptrdiff_t i = kBytesAhead; i < kBytesAhead + 2 * pillars; i += 64) {
    __builtin_prefetch(top + i);
    __builtin_prefetch(bottom + i);
  }
}

}  // namespace pillarfield::bench
