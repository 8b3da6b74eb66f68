#include "simulation/effects/pillar_model.h"

#include <cstddef>

namespace pillarfield {
namespace {

using double_precision::Force;

/// Force on a pillar, and zero beyond the skin.
Force force_at(const ForceField& forces, std::int64_t row, std::int64_t col) {
  if (row < 0 || col < 0 || row >= forces.rows || col >= forces.cols) return {0, 0, 0};
  const auto pillar = static_cast<std::size_t>(row * forces.cols + col);
  return {forces.shear_x[pillar], forces.shear_y[pillar], forces.normal[pillar]};
}

}  // namespace

PillarModel::PillarModel(const SensorEffects& effects)
    : leak_(effects.pillar_leak.value_or(PillarLeak{})),
      per_arm_(effects.arm_mm ? 1 / *effects.arm_mm : 0),
      coefficient_(effects.shear_coefficient.value_or(ShearCoefficient{})) {
  is_ideal_ = leak_.edge == 0 && leak_.corner == 0 && per_arm_ == 0 && coefficient_.x == 1 &&
              coefficient_.y == 1;
}

Force PillarModel::force_on_sensels(const ForceField& forces, const PressureMoments& moments,
                                    std::uint32_t row, std::uint32_t col) const {
  Force sum = force_at(forces, row, col);
  const auto leak_from = [&](std::int64_t down, std::int64_t right, double fraction) {
    const Force f = force_at(forces, row + down, col + right);
    sum = {sum.shear_x + fraction * f.shear_x, sum.shear_y + fraction * f.shear_y,
           sum.normal + fraction * f.normal};
  };
  if (leak_.edge != 0 || leak_.corner != 0) {
    for (const int sign : {-1, 1}) {
      leak_from(sign, 0, leak_.edge);
      leak_from(0, sign, leak_.edge);
      leak_from(sign, sign, leak_.corner);
      leak_from(sign, -sign, leak_.corner);
    }
  }
  if (per_arm_ != 0) {
    const std::size_t pillar = std::size_t{row} * forces.cols + col;
    sum.shear_x += moments.x[pillar] * per_arm_;
    sum.shear_y += moments.y[pillar] * per_arm_;
  }
  return {coefficient_.x * sum.shear_x, coefficient_.y * sum.shear_y, sum.normal};
}

}  // namespace pillarfield
