#pragma once

#include "pillarfield/solver_plan.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"

namespace pillarfield {

/// The stages of kernels/frame/stages.h that a plan names, with their constants, in the precision
/// of `Stages`: single_precision::Stages or double_precision::Stages.
template <class Stages>
Stages plan_constants(const SolverPlan& plan) {
  using Real = decltype(Stages::threshold);
  const Calibration& calibration = plan.calibration;
  const Skin& skin = plan.skin;
  const PowerLaw power_law = skin.power_law.value_or(PowerLaw{});
  const ForceScale scale = force_scale(skin.counts_per_newton);
  const auto real = [](double value) { return static_cast<Real>(value); };
  return {.range = plan.sensel_type == SenselType::f32,
          .mask = !calibration.mask.empty(),
          .saturation = skin.full_scale_counts.has_value(),
          .tare = !calibration.tare.empty(),
          .gain = !calibration.gain.empty(),
          .power_law = skin.power_law.has_value(),
          .dead_zone = !calibration.dead_zone.empty(),
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
          .scale = {real(scale.shear), real(scale.normal)}};
}

}  // namespace pillarfield
