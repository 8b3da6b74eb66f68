#pragma once

#include <cstddef>

#include "pillarfield/sensor_effects.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Reading of a sensel under uniform load, relative to one without leak, if `missing` of its two
/// neighbours under other pillars are beyond the skin's edge: 1 + 2 inside +
/// (2 − missing) across. Dead zones lie before this leak and after that between pillars.
[[nodiscard]] inline double sensel_leak_sum(const SensorEffects& effects, int missing = 0) {
  const SenselLeak sensel = effects.sensel_leak.value_or(SenselLeak{});
  return 1 + 2 * sensel.inside + (2 - missing) * sensel.across;
}

/// Load that a pillar with eight neighbours carries under a uniform load, as a multiple.
[[nodiscard]] inline double pillar_leak_sum(const SensorEffects& effects) {
  const PillarLeak pillar = effects.pillar_leak.value_or(PillarLeak{});
  return 1 + 4 * pillar.edge + 4 * pillar.corner;
}

/// Reading of a sensel under a uniform load, as a multiple.
[[nodiscard]] inline double full_leak_sum(const SensorEffects& effects) {
  return sensel_leak_sum(effects) * pillar_leak_sum(effects);
}

/// sensel_leak_sum() of the sensel with this index.
[[nodiscard]] inline double sensel_leak_sum(const SensorEffects& effects, const Skin& skin,
                                            std::size_t sensel) {
  const std::size_t row = sensel / skin.cols;
  const std::size_t col = sensel % skin.cols;
  const std::size_t solved_rows = skin.has_pillars() ? 2 * skin.pillar_rows() : skin.rows;
  const std::size_t solved_cols = skin.has_pillars() ? 2 * skin.pillar_cols() : skin.cols;
  const int at_row_edge = row == 0 || row + 1 == solved_rows ? 1 : 0;
  const int at_col_edge = col == 0 || col + 1 == solved_cols ? 1 : 0;
  return sensel_leak_sum(effects, at_row_edge + at_col_edge);
}

/// full_leak_sum() of the sensel with this index. All pillars count as having eight neighbours.
[[nodiscard]] inline double leak_sum(const SensorEffects& effects, const Skin& skin,
                                     std::size_t sensel) {
  return sensel_leak_sum(effects, skin, sensel) * pillar_leak_sum(effects);
}

}  // namespace pillarfield
