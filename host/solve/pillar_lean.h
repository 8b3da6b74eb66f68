#pragma once

#include <cstdint>

#include "pillarfield/force_field.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// The lean of a pillar along x and y (docs/derivations/sensor_effects.md, E7).
struct PillarLean {
  single_precision::Lean x;
  single_precision::Lean y;
};

/// A lean from the normal forces of five pillars in a line, as single_precision::lean_between.
using LeanOfLine = single_precision::Lean (*)(float, float, float, float, float);

/// The lean of the pillar `index` from its normal force and those of its row and column; zero
/// beyond the edge.
[[nodiscard]] inline PillarLean pillar_lean(
    const ForceFieldView& forces, std::size_t index,
    LeanOfLine lean_of_line = single_precision::lean_between) {
  const auto row = static_cast<std::int64_t>(index / forces.cols);
  const auto col = static_cast<std::int64_t>(index % forces.cols);
  const auto normal = [&](std::int64_t down, std::int64_t right) {
    const std::int64_t r = row + down;
    const std::int64_t c = col + right;
    const bool exists = r >= 0 && c >= 0 && r < forces.rows && c < forces.cols;
    return exists ? forces.normal[static_cast<std::size_t>(r * forces.cols + c)] : 0.0F;
  };
  const auto along = [&](std::int64_t down, std::int64_t right) {
    return lean_of_line(normal(-2 * down, -2 * right), normal(-down, -right), forces.normal[index],
                        normal(down, right), normal(2 * down, 2 * right));
  };
  return {along(0, 1), along(-1, 0)};
}

}  // namespace pillarfield
