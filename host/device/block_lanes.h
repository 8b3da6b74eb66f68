#pragma once

#include <cstddef>
#include <cstdint>

namespace pillarfield {

/// Pillars that a work-item solves at once: the device's lanes, halved until a row has as many.
constexpr int block_lanes(int lanes, std::uint32_t pillar_cols) {
  while (lanes > 1 && static_cast<std::uint32_t>(lanes) > pillar_cols) lanes /= 2;
  return lanes;
}

/// Blocks of a pillar row at most, the stride of flags; as in kernels/frame/calibration_planes.h.
constexpr std::size_t blocks_of_row(std::uint32_t pillar_cols, std::uint32_t lanes) {
  return pillar_cols / lanes + 2;
}

}  // namespace pillarfield
