#pragma once

#include "pillarfield/solver_plan.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"
#include "solve/sensor_corrections.h"

namespace pillarfield {

/// The stages of kernels/frame/stages.h that a plan names, with their constants, in the precision
/// of `Stages`: single_precision::Stages or double_precision::Stages. The polynomial of the
/// response curve, the weights of the leak and the model of the memory stay unset.
template <class Stages>
Stages plan_constants(const SolverPlan& plan) {
  using Real = decltype(Stages::threshold);
  const Calibration& calibration = plan.calibration;
  const Skin& skin = plan.skin;
  const PowerLaw power_law = skin.power_law.value_or(PowerLaw{});
  const ForceScale scale = force_scale(skin.counts_per_newton);
  const SensorEffects& effects = calibration.effects;
  const ShearCoefficient coefficient = effects.shear_coefficient.value_or(ShearCoefficient{});
  const ResidualError residual = effects.residual.value_or(ResidualError{});
  const PillarTaps pillar_taps =
      effects.pillar_leak ? pillar_leak_taps(*effects.pillar_leak) : PillarTaps{};
  const auto real = [](double value) { return static_cast<Real>(value); };
  return {.range = plan.sensel_type == SenselType::f32,
          .mask = !calibration.mask.empty(),
          .saturation = skin.full_scale_counts.has_value(),
          .wires = effects.wires.has_value(),
          .wires_after_tare = has_offset_tares(effects),
          .tare = !calibration.tare.empty() || !calibration.bend_x.empty(),
          .gain = !calibration.gain.empty(),
          .power_law = skin.power_law.has_value(),
          .curve = !effects.curve.empty(),
          .leak = effects.sensel_leak.has_value(),
          .memory = effects.memory.has_value(),
          .dead_zone = !calibration.dead_zone.empty(),
          .shear_coefficient = effects.shear_coefficient.has_value(),
          .residual = effects.residual.has_value(),
          .pillar_leak = effects.pillar_leak.has_value(),
          .arm = effects.arm_mm.has_value(),
          .paper = plan.estimator == Estimator::paper,
          .parity_test = plan.parity_tolerance_counts.has_value(),
          .angles = plan.angles,
          .uncertainty = plan.uncertainty,
          .largest = real(kMaxCounts),
          .full_scale = real(skin.full_scale_counts.value_or(0)),
          .exponent = real(power_law.exponent),
          .reference = real(power_law.reference_counts),
          .threshold = real(skin.threshold_counts),
          .segment_point = real(plan.segment_point),
          .margin = real(region_margin(plan)),
          .parity_tolerance = real(plan.parity_tolerance_counts.value_or(0)),
          .scale = {real(scale.shear), real(scale.normal)},
          .curve_polynomial = {},
          .leak_taps = {},
          .memory_model = {},
          .per_coefficient_x = real(1 / coefficient.x),
          .per_coefficient_y = real(1 / coefficient.y),
          .residual_relative = real(residual.relative),
          .residual_variance = real(residual.offset_counts * residual.offset_counts),
          .relative_margin = real(region_margin(residual.relative)),
          .pillar_leak_self = real(pillar_taps.self),
          .pillar_leak_edge = real(pillar_taps.edge),
          .pillar_leak_corner = real(pillar_taps.corner),
          .lean = real(skin.pillar_pitch_mm() / effects.arm_mm.value_or(1))};
}

}  // namespace pillarfield
