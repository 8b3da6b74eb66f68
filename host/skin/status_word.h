#pragma once

#include <cstddef>
#include <cstdint>

namespace pillarfield {

inline constexpr std::size_t kWordBytes = sizeof(std::uint64_t);
inline constexpr std::uint64_t kEachByte = 0x0101010101010101u;  ///< the lowest bit of each byte

}  // namespace pillarfield
