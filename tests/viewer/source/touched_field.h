#pragma once

#include <initializer_list>
#include <memory>

#include "pillarfield/status.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// A rectangle of pillars with equal forces, N.
struct Touch {
  PillarRect rect;
  float normal = 1, shear_x = 0, shear_y = 0;
};

/// A field of touches, idle elsewhere.
inline ShownField touched_field(std::uint64_t index, std::uint32_t rows, std::uint32_t cols,
                                std::initializer_list<Touch> touches) {
  const auto forces = std::make_shared<ForceField>(rows, cols);
  for (const Touch& touch : touches) {
    for (std::uint32_t row = touch.rect.row_begin; row < touch.rect.row_end; ++row) {
      for (std::uint32_t col = touch.rect.col_begin; col < touch.rect.col_end; ++col) {
        const std::size_t at = std::size_t{row} * cols + col;
        forces->normal[at] = touch.normal;
        forces->shear_x[at] = touch.shear_x;
        forces->shear_y[at] = touch.shear_y;
        forces->status[at] = status::kUsable;
      }
    }
  }
  ShownField field;
  field.forces = forces->view();
  field.index = index;
  field.time_s = 0.01 * static_cast<double>(index);
  field.keep_alive = forces;
  return field;
}

}  // namespace pillarfield::viewer
