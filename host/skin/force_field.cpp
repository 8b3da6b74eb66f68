#include "pillarfield/force_field.h"

#include <algorithm>

namespace pillarfield {
ForceField::ForceField(std::uint32_t pillar_rows, std::uint32_t pillar_cols)
    : rows(pillar_rows),
      cols(pillar_cols),
      shear_x(elements()),
      shear_y(elements()),
      normal(elements()),
      status(elements()) {}

ForceField::ForceField(const Skin& skin) : ForceField(skin.element_rows(), skin.element_cols()) {
  if (skin.has_pillars()) return;
  shear_x.clear();
  shear_y.clear();
}

ForceField::ForceField(const ForceFieldView& field)
    : rows(field.rows),
      cols(field.cols),
      shear_x(field.shear_x.begin(), field.shear_x.end()),
      shear_y(field.shear_y.begin(), field.shear_y.end()),
      normal(field.normal.begin(), field.normal.end()),
      status(field.status.begin(), field.status.end()) {
  std::ranges::transform(field.uncertainty, uncertainty.begin(), [](std::span<const float> plane) {
    return std::vector(plane.begin(), plane.end());
  });
}

ForceFieldView ForceField::view() const {
  ForceFieldView view = {rows, cols, shear_x, shear_y, normal, status, {}, {}, {}, {}};
  std::ranges::copy(uncertainty, view.uncertainty.begin());
  return view;
}

}  // namespace pillarfield
