#pragma once

#include <array>
#include <cstddef>

#include "pillarfield/skin.h"

namespace pillarfield {

/// Indices of sensels 1 to 4 of a pillar in a plane of sensels.
inline std::array<std::size_t, 4> pillar_sensels(const Skin& skin, std::size_t pillar_row,
                                                 std::size_t pillar_col) {
  const std::size_t upper_left = 2 * pillar_row * skin.cols + 2 * pillar_col;
  const std::size_t lower_left = upper_left + skin.cols;
  return {upper_left + 1, upper_left, lower_left, lower_left + 1};
}

/// Calls `use(row, col, sensels)` for each pillar of the skin.
template <class Use>
void for_each_pillar(const Skin& skin, Use use) {
  for (std::uint32_t row = 0; row < skin.pillar_rows(); ++row) {
    for (std::uint32_t col = 0; col < skin.pillar_cols(); ++col) {
      use(row, col, pillar_sensels(skin, row, col));
    }
  }
}

/// Calls `use(sensel)` for each sensel of an element: pillar by pillar, or, without pillars, all.
template <class Use>
void for_each_solved_sensel(const Skin& skin, Use use) {
  if (!skin.has_pillars()) {
    for (std::size_t i = 0; i < skin.sensels(); ++i) use(i);
    return;
  }
  for_each_pillar(skin, [&](auto, auto, const auto& sensels) {
    for (const std::size_t i : sensels) use(i);
  });
}

}  // namespace pillarfield
