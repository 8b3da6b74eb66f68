#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "pillarfield/skin.h"

namespace pillarfield {

/// The blocks of 2 x 2 sensels in which a frame is solved: pillars, or, without pillars, as many as
/// hold all sensels. The last row or column of the latter may lack sensels.
[[nodiscard]] inline std::uint32_t quad_rows(const Skin& skin) {
  return (skin.rows + (skin.has_pillars() ? 0 : 1)) / 2;
}
[[nodiscard]] inline std::uint32_t quad_cols(const Skin& skin) {
  return (skin.cols + (skin.has_pillars() ? 0 : 1)) / 2;
}
[[nodiscard]] inline std::size_t quads(const Skin& skin) {
  return std::size_t{quad_rows(skin)} * quad_cols(skin);
}

/// Rows and columns of a frame in a device's memory: those of the skin, and without pillars at
/// least those of its quads.
[[nodiscard]] inline std::uint32_t padded_rows(const Skin& skin) {
  return std::max(skin.rows, 2 * quad_rows(skin));
}
[[nodiscard]] inline std::uint32_t padded_cols(const Skin& skin) {
  return std::max(skin.cols, 2 * quad_cols(skin));
}
[[nodiscard]] inline std::size_t padded_sensels(const Skin& skin) {
  return std::size_t{padded_rows(skin)} * padded_cols(skin);
}

}  // namespace pillarfield
