#include "lab/studies/small_forces.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "lab/studies/bound.h"
#include "pillarfield/comparison.h"
#include "pillarfield/coverage.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"
#include "simulation/ideal_readings.h"
#include "simulation/sensor.h"

namespace pillarfield::small_forces_study {
namespace {

constexpr std::uint32_t kSide = 64;  // pillars, rows and columns of a frame
static_assert(kSide * kSide == kStudyDirections);

Scene study_scene() {
  Scene scene;
  scene.skin.rows = 2 * kSide;
  scene.skin.cols = 2 * kSide;
  scene.skin.threshold_counts = kStudyThresholdCounts;
  scene.skin.full_scale_counts = 65535;
  scene.sensor.dead_zone_counts = kStudyDeadZoneCounts;
  scene.sensor.noise_counts = kStudyNoiseCounts;
  scene.sensor.adc_bits = 16;
  return scene;
}

/// Forces of one magnitude with directions spread evenly over the hemisphere, in a golden spiral.
ForceField forces_over_hemisphere(double magnitude_n) {
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  ForceField truth(kSide, kSide);
  for (std::size_t i = 0; i < truth.elements(); ++i) {
    const double fraction = (static_cast<double>(i) + 0.5) / static_cast<double>(truth.elements());
    const bound::Force force = bound::force_from(magnitude_n, std::acos(1 - fraction),
                                                 golden_angle * static_cast<double>(i));
    truth.shear_x[i] = static_cast<float>(force.shear_x);
    truth.shear_y[i] = static_cast<float>(force.shear_y);
    truth.normal[i] = static_cast<float>(force.normal);
  }
  return truth;
}

/// Returns the readings of the forces, and sets their status bytes to those of the ideal model.
FrameBuffer read_forces(const Scene& scene, ForceField& truth) {
  const Sensor sensor(scene);
  FrameBuffer raw(sensor.sensel_type(), scene.skin.rows, scene.skin.cols);
  for (std::uint32_t row = 0; row < kSide; ++row) {
    std::vector<double> upper;
    std::vector<double> lower;
    for (std::size_t i = std::size_t{row} * kSide; i < std::size_t{row + 1} * kSide; ++i) {
      const auto v = ideal_readings({truth.shear_x[i], truth.shear_y[i], truth.normal[i]},
                                    scene.skin.counts_per_newton);
      truth.status[i] = usable_bits(v);
      upper.insert(upper.end(), {v.v2, v.v1});
      lower.insert(lower.end(), {v.v3, v.v4});
    }
    sensor.read_row(0, 2 * row, upper, raw);
    sensor.read_row(0, 2 * row + 1, lower, raw);
  }
  return raw;
}

SolverPlan plan_of(const Scene& scene, Estimator estimator, bool has_dead_zone) {
  SolverPlan plan;
  plan.skin = scene.skin;
  plan.sensel_type = SenselType::u16;
  plan.noise_counts = scene.sensor.noise_counts;
  plan.estimator = estimator;
  plan.uncertainty = estimator == Estimator::direct;
  if (has_dead_zone) {
    plan.calibration.dead_zone.assign(scene.skin.sensels(),
                                      static_cast<float>(scene.sensor.dead_zone_counts));
  }
  return plan;
}

/// Fraction of pillars with the truth inside the intervals.
double held_fraction(const ForceField& solved, const ForceField& truth) {
  Coverage coverage;
  coverage.add(solved.view(), truth.view());
  double held = 0;
  for (int region = 0; region < kRegions; ++region) {
    const RegionCoverage part = coverage.region(static_cast<Region>(region));
    held += part.ends * static_cast<double>(part.pillars);
  }
  return held / static_cast<double>(truth.elements());
}

/// RMS of |solved − true| / |true| over pillars in regions 1 and 2; NaN without any.
double determined_error(const ForceField& solved, const ForceField& truth) {
  double squares = 0;
  double count = 0;
  for (std::size_t i = 0; i < truth.elements(); ++i) {
    const Region region = region_of(solved.status[i]);
    if (region != Region::one && region != Region::two) continue;
    const double error =
        std::hypot(solved.shear_x[i] - truth.shear_x[i], solved.shear_y[i] - truth.shear_y[i],
                   solved.normal[i] - truth.normal[i]);
    const double magnitude = std::hypot(truth.shear_x[i], truth.shear_y[i], truth.normal[i]);
    squares += error * error / (magnitude * magnitude);
    count += 1;
  }
  return std::sqrt(squares / count);
}

SmallForceErrors errors_of(const ForceField& solved, const ForceField& truth) {
  SmallForceErrors errors{};
  for (std::size_t i = 0; i < truth.elements(); ++i) {
    const Region region = region_of(solved.status[i]);
    const bool detected = region != Region::none;
    const bool wrong = detected && region != region_of(truth.status[i]);
    const bool flagged = (solved.status[i] & (status::kAmbiguous | status::kInconsistent)) != 0;
    errors.undetected += detected ? 0 : 1;
    errors.wrong_region += wrong ? 1 : 0;
    errors.unflagged += wrong && !flagged ? 1 : 0;
  }
  for (double* count : {&errors.undetected, &errors.wrong_region, &errors.unflagged}) {
    *count /= static_cast<double>(truth.elements());
  }
  Comparison comparison;
  comparison.add(solved.view(), truth.view());
  const RegionErrors all = comparison.loaded();
  errors.force = all.rms_relative;
  errors.theta_rad = all.theta_rms_rad;
  errors.phi_rad = all.phi_rms_rad;
  errors.determined = determined_error(solved, truth);
  return errors;
}

SmallForceErrors study(const SolverPlan& plan, const FrameBuffer& raw, const ForceField& truth) {
  const ForceField solved = solve_on_host(plan, raw.view());
  SmallForceErrors errors = errors_of(solved, truth);
  if (plan.uncertainty) errors.held = held_fraction(solved, truth);
  return errors;
}

SmallForcePoint point_at(double load) {
  const Scene scene = study_scene();
  ForceField truth =
      forces_over_hemisphere(load * kStudyDeadZoneCounts / scene.skin.counts_per_newton);
  const FrameBuffer raw = read_forces(scene, truth);
  return {load, study(plan_of(scene, Estimator::paper, false), raw, truth),
          study(plan_of(scene, Estimator::direct, false), raw, truth),
          study(plan_of(scene, Estimator::direct, true), raw, truth)};
}

}  // namespace

std::vector<SmallForcePoint> small_forces() {
  std::vector<SmallForcePoint> points;
  for (const double load :
       {0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 70.0, 100.0}) {
    points.push_back(point_at(load));
  }
  return points;
}

}  // namespace pillarfield::small_forces_study
