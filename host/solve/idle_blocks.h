#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pillarfield {

/// Which blocks of a frame's pillars are known to bear no load, so that nobody need look there.
///
/// A block is so many pillars whose places, counted row by row through the frame, begin at a
/// multiple of that number; where a row ends, so does its last block, and the next row begins with
/// the rest of it.
struct IdleBlocks {
  /// [rows, stride], 1 for a block without a loaded pillar, else 0; of each row the first ones
  /// count, as many as it has blocks. Empty: nothing is known.
  std::span<const std::uint8_t> marks;
  std::size_t stride = 0;
  std::uint32_t pillars = 1;  ///< of a block
};

}  // namespace pillarfield
