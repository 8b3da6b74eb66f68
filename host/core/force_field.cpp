#include "pillarfield/force_field.h"

namespace pillarfield {

ForceField::ForceField(std::uint32_t pillar_rows, std::uint32_t pillar_cols)
    : rows(pillar_rows),
      cols(pillar_cols),
      shear_x(pillars()),
      shear_y(pillars()),
      normal(pillars()),
      status(pillars()) {}

ForceFieldView ForceField::view() const {
  return {rows, cols, shear_x, shear_y, normal, status, {}, {}, {}};
}

}  // namespace pillarfield
