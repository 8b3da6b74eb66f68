#include "pillarfield/force_field.h"

#include <algorithm>

namespace pillarfield {
namespace {

std::vector<float> to_floats(std::span<const Half> halves) {
  std::vector<float> floats(halves.size());
  std::ranges::transform(halves, floats.begin(), to_float);
  return floats;
}

}  // namespace

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

ForceField to_single(const HalfFieldView& half) {
  ForceField field(half.rows, half.cols);
  field.shear_x = to_floats(half.shear_x);
  field.shear_y = to_floats(half.shear_y);
  field.normal = to_floats(half.normal);
  field.status.assign(half.status.begin(), half.status.end());
  std::ranges::transform(half.uncertainty, field.uncertainty.begin(), to_floats);
  return field;
}

}  // namespace pillarfield
