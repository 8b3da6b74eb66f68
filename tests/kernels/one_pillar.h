#pragma once

#include <array>
#include <optional>

#include "pillarfield/solver_plan.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// Sensor parameters of one pillar, counts.
struct PillarSensor {
  double counts_per_newton = 1;
  double threshold_counts = 0;
  double dead_zone_counts = 0;
  std::optional<double> full_scale_counts;
  double noise_counts = 0;  ///< standard deviation; 0: unknown
};

/// The types of kernels/frame/stages.h in the precision of Real.
template <class Real>
struct PillarTypes;
template <>
struct PillarTypes<float> {
  using Stages = single_precision::Stages;
  using Solution = single_precision::Solution;
};
template <>
struct PillarTypes<double> {
  using Stages = double_precision::Stages;
  using Solution = double_precision::Solution;
};

/// Results of one pillar: force (N), direction (N, rad) and status; of the direct estimate also
/// deviations (N) and interval (N, rad).
template <class Real>
using PillarEstimate = typename PillarTypes<Real>::Solution;

/// The stages of a pillar with this sensor, without the paper's estimator.
template <class Real>
typename PillarTypes<Real>::Stages pillar_stages(const PillarSensor& sensor) {
  typename PillarTypes<Real>::Stages stages{};
  const ForceScale scale = force_scale(sensor.counts_per_newton);
  stages.reject_out_of_range = stages.dead_zone = stages.angles = stages.uncertainty = true;
  stages.saturation = sensor.full_scale_counts.has_value();
  stages.largest = static_cast<Real>(kMaxCounts);
  stages.full_scale = static_cast<Real>(sensor.full_scale_counts.value_or(0));
  stages.threshold = static_cast<Real>(sensor.threshold_counts);
  stages.margin = static_cast<Real>(region_margin(sensor.noise_counts));
  stages.shear_scale = static_cast<Real>(scale.shear);
  stages.normal_scale = static_cast<Real>(scale.normal);
  return stages;
}

/// Applies the stages of a sensel to a raw reading.
template <class Real>
auto prepare_sensel(Real raw, const PillarSensor& sensor) {
  return correct_sensel(raw, {0, 0, static_cast<Real>(sensor.dead_zone_counts), 0, {}},
                        pillar_stages<Real>(sensor));
}

/// Solves one pillar from the raw readings of its sensels 1 to 4, counts, in float or double, with
/// the functions of the kernels. `segment_point` is that of SolverPlan.
template <class Real>
PillarEstimate<Real> estimate_pillar(const std::array<Real, 4>& raw, const PillarSensor& sensor,
                                     Estimator estimator, double segment_point = kSegmentPoint) {
  auto stages = pillar_stages<Real>(sensor);
  stages.segment_point = static_cast<Real>(segment_point);
  const auto noise = static_cast<Real>(sensor.noise_counts);
  const auto estimate = [&] {
    return solve_pillar({prepare_sensel(raw[0], sensor), prepare_sensel(raw[1], sensor),
                         prepare_sensel(raw[2], sensor), prepare_sensel(raw[3], sensor)},
                        {noise, noise, noise, noise}, stages);
  };
  PillarEstimate<Real> solution = estimate();
  if (estimator != Estimator::paper) return solution;
  stages.paper_solve = true;
  const PillarEstimate<Real> paper = estimate();
  solution.force = paper.force;
  solution.direction = paper.direction;
  return solution;
}

}  // namespace pillarfield
