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

/// The lean of the pillar `index` from its normal force and those beside it; zero beyond the edge.
[[nodiscard]] inline PillarLean pillar_lean(const ForceFieldView& forces, std::size_t index) {
  const std::size_t row = index / forces.cols;
  const std::size_t col = index - row * forces.cols;
  const auto normal = [&](bool exists, std::size_t at) { return exists ? forces.normal[at] : 0; };
  const float own = forces.normal[index];
  return {single_precision::lean_between(normal(col > 0, index - 1), own,
                                         normal(col + 1 < forces.cols, index + 1)),
          single_precision::lean_between(normal(row + 1 < forces.rows, index + forces.cols), own,
                                         normal(row > 0, index - forces.cols))};
}

}  // namespace pillarfield
