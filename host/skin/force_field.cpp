#include "pillarfield/force_field.h"

#include <algorithm>

namespace pillarfield {
ForceField::ForceField(std::uint32_t pillar_rows, std::uint32_t pillar_cols)
    : rows(pillar_rows),
      cols(pillar_cols),
      shear_x(pillars()),
      shear_y(pillars()),
      normal(pillars()),
      status(pillars()) {}

ForceFieldView ForceField::view() const {
  ForceFieldView view = {rows, cols, shear_x, shear_y, normal, status, {}, {}, {}, {}};
  std::ranges::copy(uncertainty, view.uncertainty.begin());
  return view;
}

}  // namespace pillarfield
