#pragma once

#include <cstddef>

#include "pillarfield/sensor_effects.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// What a sensel reads under a uniform load as a multiple of what it would read without the leaks
/// of `effects`: 1 + 2 inside + 2 across, less across for each neighbour that the skin's edge
/// lacks, times 1 + 4 edge + 4 corner of the leak between pillars.
[[nodiscard]] inline double leak_sum(const SensorEffects& effects, const Skin& skin,
                                     std::size_t sensel) {
  double sum = 1;
  if (const auto& leak = effects.sensel_leak) {
    const std::size_t row = sensel / skin.cols;
    const std::size_t col = sensel % skin.cols;
    const int at_row_edge = row == 0 || row + 1 == 2 * skin.pillar_rows() ? 1 : 0;
    const int at_col_edge = col == 0 || col + 1 == 2 * skin.pillar_cols() ? 1 : 0;
    sum += 2 * leak->inside + (2 - at_row_edge - at_col_edge) * leak->across;
  }
  if (const auto& leak = effects.pillar_leak) sum *= 1 + 4 * leak->edge + 4 * leak->corner;
  return sum;
}

}  // namespace pillarfield
