#pragma once

#include <cstdint>
#include <vector>

namespace pillarfield {

/// A picture of 8-bit RGB, row by row from the top left.
struct RgbPicture {
  std::uint32_t width = 0;   ///< pixels
  std::uint32_t height = 0;  ///< pixels
  std::vector<std::uint8_t> rgb = {};
};

}  // namespace pillarfield
