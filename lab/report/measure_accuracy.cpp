// measure_accuracy: the measurements of docs/accuracy.md, as one JSON document on standard output.
// The result depends on nothing but the code.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "lab/studies/bound.h"
#include "lab/studies/coverage_study.h"
#include "pillarfield/comparison.h"
#include "pillarfield/coverage.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"

namespace pillarfield::report {
namespace {

using Json = nlohmann::ordered_json;
using bound::Force;
using bound::PillarSensor;

// --- Error against the Cramér–Rao bound ---

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kForceCounts = 60;
constexpr double kFar = 3;  // standard deviations from a border
constexpr int kDraws = 40'000;

/// One newton is one count.
PillarSensor sensor_of(double noise_counts) {
  PillarSensor sensor;
  sensor.threshold_counts = 5 * noise_counts;
  sensor.noise_counts = noise_counts;
  return sensor;
}

Force force_from(double theta_deg, double phi_deg) {
  return bound::force_from(kForceCounts, theta_deg * kDegree, phi_deg * kDegree);
}

bool has_bound(Force force, const PillarSensor& sensor) {
  return bound::usable_sensels(force, sensor) >= 3;
}

bool is_measured(Force force, const PillarSensor& sensor) {
  return has_bound(force, sensor) && bound::is_far_from_borders(force, sensor, kFar);
}

/// RMS errors of both estimators over the bound. `number` distinguishes the noise of experiments.
Json ratios(Force force, const PillarSensor& sensor, std::uint64_t number) {
  const double least = bound::least_error(force, sensor);
  const auto direct = bound::rms_error(force, sensor, Estimator::direct, kDraws, 2 * number);
  const auto paper = bound::rms_error(force, sensor, Estimator::paper, kDraws, 2 * number + 1);
  return {{"usable", bound::usable_sensels(force, sensor)},
          {"direct", direct.of_rightly_read / least},
          {"direct_all_draws", direct.of_all / least},
          {"paper", paper.of_rightly_read / least}};
}

/// For each inclination and noise, the forces from azimuths all round a quarter that have a bound
/// and are far from the borders of regions.
Json bound_table() {
  Json table = Json::array();
  std::uint64_t number = 0;
  for (int theta_deg = 0; theta_deg <= 80; theta_deg += 10) {
    for (const double noise_counts : {0.5, 1.0, 2.0}) {
      const PillarSensor sensor = sensor_of(noise_counts);
      Json forces = Json::array();
      for (int i = 0; i < 12; ++i) {
        const Force force = force_from(theta_deg, 7.5 * (i + 0.5));
        if (is_measured(force, sensor)) forces.push_back(ratios(force, sensor, ++number));
      }
      table.push_back({{"theta_deg", theta_deg},
                       {"noise_counts", noise_counts},
                       {"forces", std::move(forces)}});
    }
  }
  return table;
}

Json bound_curves() {
  const PillarSensor sensor = sensor_of(1);
  Json curves = Json::array();
  std::uint64_t number = 1'000'000;
  for (const double phi_deg : {45.0, 22.5}) {
    Json points = Json::array();
    for (int theta_deg = 0; theta_deg < 90; ++theta_deg) {
      const Force force = force_from(theta_deg, phi_deg);
      if (!has_bound(force, sensor)) continue;
      Json point = ratios(force, sensor, ++number);
      point["theta_deg"] = theta_deg;
      point["near_border"] = !bound::is_far_from_borders(force, sensor, kFar);
      points.push_back(std::move(point));
    }
    curves.push_back({{"phi_deg", phi_deg}, {"points", std::move(points)}});
  }
  return curves;
}

Json bound_json() {
  return {{"force_counts", kForceCounts},
          {"draws", kDraws},
          {"far_deviations", kFar},
          {"table", bound_table()},
          {"curves", bound_curves()}};
}

// --- Coverage ---

Json json_of(const Coverage& coverage) {
  Json regions = Json::array();
  for (const Region region : {Region::one, Region::two, Region::three, Region::four}) {
    const RegionCoverage c = coverage.region(region);
    regions.push_back({{"pillars", c.pillars},
                       {"shear_x", c.shear_x},
                       {"shear_y", c.shear_y},
                       {"normal", c.normal},
                       {"ends", c.ends}});
  }
  return regions;
}

Json coverage_json() {
  Json scenes = Json::array();
  for (const coverage_study::Study& study : coverage_study::studies()) {
    const auto parted = coverage_study::cover(study.scene);
    scenes.push_back({{"name", study.name},
                      {"all", json_of(parted.all)},
                      {"as_without_noise", json_of(parted.rightly_read)},
                      {"usable_by_luck", json_of(parted.by_luck)},
                      {"inactive_by_bad_luck", json_of(parted.by_bad_luck)}});
  }
  return scenes;
}

// --- Small forces ---

// Errors that a dead zone causes in small forces, with and without its calibration.

/// Fractions of forces and errors over all directions of the hemisphere.
struct SmallForceErrors {
  double undetected;    ///< fraction without any usable sensel
  double wrong_region;  ///< fraction in another region than in the ideal model
  double unflagged;     ///< fraction in a wrong region without a status bit
  double force;         ///< RMS of |solved − true| / |true|
  double theta_rad;     ///< RMS
  double phi_rad;       ///< RMS, weighted with sin(theta)
  double determined;    ///< `force` over forces with three or four usable sensels
  double held;          ///< fraction with the truth inside the intervals (see Coverage)
};

/// Forces of one magnitude.
struct SmallForcePoint {
  double load;              ///< F k / z: counts of a normal force over the dead zone
  SmallForceErrors paper;   ///< the paper's equations, without dead zone and intervals
  SmallForceErrors naive;   ///< the direct solve without the dead zone
  SmallForceErrors direct;  ///< the direct solve with the dead zone
};

/// Number of directions of each magnitude.
inline constexpr int kStudyDirections = 4096;

/// The sensor of the study; k is the default of Skin.
inline constexpr double kStudyDeadZoneCounts = 20;
inline constexpr double kStudyNoiseCounts = 0.5;
inline constexpr double kStudyThresholdCounts = 3;

constexpr std::uint32_t kSide = 64;  // pillars, rows and columns of a frame
static_assert(kSide * kSide == kStudyDirections);
constexpr double kFullScaleCounts = 65535;

Skin study_skin() {
  Skin skin;
  skin.rows = 2 * kSide;
  skin.cols = 2 * kSide;
  skin.threshold_counts = kStudyThresholdCounts;
  skin.full_scale_counts = kFullScaleCounts;
  return skin;
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

/// The status bits of the ideal model. A V within the rounding error of single-precision forces,
/// 1e-6 of the pillar's largest |V|, is zero.
std::uint8_t ideal_bits(const std::array<double, 4>& v) {
  double largest = 0;
  for (const double each : v) largest = std::max(largest, std::abs(each));
  return bound::bits_above(v, 1e-6 * largest);
}

/// Returns the readings of the forces, and sets their status bytes to those of the ideal model.
FrameBuffer read_forces(const Skin& skin, ForceField& truth) {
  FrameBuffer raw(SenselType::u16, skin.rows, skin.cols);
  const auto readings = raw.readings<std::uint16_t>();
  std::mt19937_64 engine(1);
  std::normal_distribution<double> noise(0, kStudyNoiseCounts);
  for (std::size_t i = 0; i < truth.elements(); ++i) {
    const auto v = bound::model_readings({truth.shear_x[i], truth.shear_y[i], truth.normal[i]},
                                         skin.counts_per_newton);
    truth.status[i] = ideal_bits(v);
    for (std::size_t n = 0; n < 4; ++n) {
      const double counts = std::max(0.0, v[n] - kStudyDeadZoneCounts) + noise(engine);
      readings[bound::place_of(i, n, kSide)] =
          static_cast<std::uint16_t>(std::lround(std::clamp(counts, 0.0, kFullScaleCounts)));
    }
  }
  return raw;
}

SolverPlan plan_of(const Skin& skin, Estimator estimator, bool has_dead_zone) {
  SolverPlan plan;
  plan.skin = skin;
  plan.sensel_type = SenselType::u16;
  plan.noise_counts = kStudyNoiseCounts;
  plan.estimator = estimator;
  plan.uncertainty = estimator == Estimator::direct;
  if (has_dead_zone) {
    plan.calibration.dead_zone.assign(skin.sensels(), static_cast<float>(kStudyDeadZoneCounts));
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
  const Skin skin = study_skin();
  ForceField truth = forces_over_hemisphere(load * kStudyDeadZoneCounts / skin.counts_per_newton);
  const FrameBuffer raw = read_forces(skin, truth);
  return {load, study(plan_of(skin, Estimator::paper, false), raw, truth),
          study(plan_of(skin, Estimator::direct, false), raw, truth),
          study(plan_of(skin, Estimator::direct, true), raw, truth)};
}

/// Solves loads from 0.3 to 100 in directions spread evenly over the hemisphere, in about 0.1 s.
std::vector<SmallForcePoint> small_forces() {
  std::vector<SmallForcePoint> points;
  for (const double load :
       {0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0, 70.0, 100.0}) {
    points.push_back(point_at(load));
  }
  return points;
}

Json json_of(const SmallForceErrors& errors) {
  return {{"undetected", errors.undetected}, {"wrong_region", errors.wrong_region},
          {"unflagged", errors.unflagged},   {"held", errors.held},
          {"determined", errors.determined}, {"force", errors.force},
          {"theta_rad", errors.theta_rad},   {"phi_rad", errors.phi_rad}};
}

Json small_forces_json() {
  Json points = Json::array();
  for (const SmallForcePoint& point : small_forces()) {
    points.push_back({{"load", point.load},
                      {"paper", json_of(point.paper)},
                      {"before", json_of(point.naive)},
                      {"after", json_of(point.direct)}});
  }
  return {{"directions", kStudyDirections},
          {"dead_zone_counts", kStudyDeadZoneCounts},
          {"noise_counts", kStudyNoiseCounts},
          {"threshold_counts", kStudyThresholdCounts},
          {"points", std::move(points)}};
}

Json all() {
  return {{"bound", bound_json()},
          {"coverage", coverage_json()},
          {"small_forces", small_forces_json()}};
}

}  // namespace
}  // namespace pillarfield::report

int main() {
  try {
    std::puts(pillarfield::report::all().dump(1).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "measure_accuracy: %s\n", error.what());
    return 1;
  }
  return 0;
}
