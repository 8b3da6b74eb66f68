#include "simulation/effects/known_effects.h"

namespace pillarfield {
namespace {

WireCrosstalk per_count(const Wires& wires, const Skin& skin) {
  const double count_siemens = 1 / (wires.sensel_ohm * full_scale_or_255(skin));
  return {wires.tile_rows,
          wires.tile_cols,
          wires.row_ohm * count_siemens,
          wires.column_ohm * count_siemens,
          wires.row_ohm * count_siemens,
          wires.tares};
}

}  // namespace

double full_scale_or_255(const Skin& skin) { return skin.full_scale_counts.value_or(255); }

SensorEffects known_effects(const SensorModel& sensor, const Skin& skin) {
  SensorEffects effects;
  effects.curve = sensor.response_curve;
  effects.shear_coefficient = sensor.shear_coefficient;
  effects.arm_mm = sensor.pillar_arm_mm;
  if (sensor.leak_inside != 0 || sensor.leak_across != 0) {
    effects.sensel_leak = {sensor.leak_inside, sensor.leak_across};
  }
  if (sensor.pillar_leak_edge != 0 || sensor.pillar_leak_corner != 0) {
    effects.pillar_leak = {sensor.pillar_leak_edge, sensor.pillar_leak_corner};
  }
  if (sensor.wires) effects.wires = per_count(*sensor.wires, skin);
  return effects;
}

}  // namespace pillarfield
