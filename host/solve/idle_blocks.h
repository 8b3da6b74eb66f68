#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pillarfield {

/// Flags of the blocks of a frame that have no loaded pillar.
///
/// Blocks begin at multiples of `pillars` in the row-by-row index of pillars. A block that crosses
/// the end of a row is divided: its rest is the first block of the next row.
struct IdleBlocks {
  /// [rows, stride]: odd for a block without a loaded pillar, else 0. Each row uses as many as it
  /// has blocks. Empty: unknown.
  std::span<const std::uint8_t> flags;
  std::size_t stride = 0;
  std::uint32_t pillars = 1;  ///< in a block
};

}  // namespace pillarfield
