// measure_accuracy: the measurements of docs/accuracy.md, as one JSON document on standard output.
// The result depends on nothing but the code.

#include <cstdint>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "lab/studies/bound.h"
#include "lab/studies/coverage_study.h"
#include "lab/studies/small_forces.h"

namespace pillarfield::report {
namespace {

using Json = nlohmann::ordered_json;
using bound::Force;

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

Json json_of(const small_forces_study::SmallForceErrors& errors) {
  return {{"undetected", errors.undetected}, {"wrong_region", errors.wrong_region},
          {"unflagged", errors.unflagged},   {"held", errors.held},
          {"determined", errors.determined}, {"force", errors.force},
          {"theta_rad", errors.theta_rad},   {"phi_rad", errors.phi_rad}};
}

Json small_forces_json() {
  Json points = Json::array();
  for (const small_forces_study::SmallForcePoint& point : small_forces_study::small_forces()) {
    points.push_back({{"load", point.load},
                      {"paper", json_of(point.paper)},
                      {"before", json_of(point.naive)},
                      {"after", json_of(point.direct)}});
  }
  return {{"directions", small_forces_study::kStudyDirections},
          {"dead_zone_counts", small_forces_study::kStudyDeadZoneCounts},
          {"noise_counts", small_forces_study::kStudyNoiseCounts},
          {"threshold_counts", small_forces_study::kStudyThresholdCounts},
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
