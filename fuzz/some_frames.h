#pragma once

#include <cstdint>
#include <set>

namespace pillarfield::fuzz {

/// Indices of the first, the last and some other frames of a file that claims `frames`.
inline std::set<std::uint64_t> some_frames(std::uint64_t frames) {
  if (frames == 0) return {};
  const std::uint64_t last = frames - 1;
  return {0, last / 2, last / 2 + last / 4, last == 0 ? 0 : last - 1, last};
}

/// Largest frame that is read, in sensels or pillars; a fuzzer needs many small files.
inline constexpr std::uint64_t kMaxRead = 1 << 20;

/// Largest frame that is solved, in sensels.
inline constexpr std::uint64_t kMaxSolved = 1 << 14;

}  // namespace pillarfield::fuzz
