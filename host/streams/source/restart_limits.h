#pragma once

#include <chrono>
#include <cstdint>

namespace pillarfield {

/// A sequence number that is further back or ahead is that of a sensor that began anew
/// (docs/stream_format.md).
inline constexpr std::uint64_t kFarBack = 1000;
inline constexpr std::uint64_t kFarAhead = 1 << 20;
/// So is one near zero after at least as many frames as PartHistory can tell late packets of.
inline constexpr std::uint64_t kNearZero = 8;
inline constexpr std::uint64_t kFewFrames = 32;
/// And one that is back at all after the end of the sequence, or after so long without packets.
inline constexpr std::chrono::milliseconds kLongestGap{500};

}  // namespace pillarfield
