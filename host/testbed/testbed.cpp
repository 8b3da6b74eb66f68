#include "testbed/testbed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/random.h"
#include "pillarfield/error.h"

namespace pillarfield::testbed {
namespace {

void require(const char* parameter, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw Error("testbed", fmt::format("the {} {} is out of range", parameter, value),
              fmt::format("give {} to {}", least, most));
}

/// Error of the probe's direction.
struct Misalignment {
  double theta_rad;
  double phi_rad;
  double theta_play_rad;  ///< further error at the largest force, proportional to the force
  double phi_play_rad;
};

Misalignment misalignment_of(const Parameters& parameters, std::uint64_t run, std::uint32_t site) {
  std::array<double, 4> uniform{};
  random::fill_uniform({parameters.seed, random::Stream::positioner, run, site}, uniform);
  const auto within = [](double bound, double u) { return bound * (2 * u - 1); };
  return {within(parameters.positioner_rad, uniform[0]),
          within(parameters.positioner_rad, uniform[1]), within(parameters.play_rad, uniform[2]),
          within(parameters.play_rad, uniform[3])};
}

/// Force on the pillar when the probe reads `applied_n`; `u` is uniform in [0, 1).
Force true_force(const Parameters& parameters, const Site& site, const Misalignment& error,
                 double applied_n, double u) {
  const double fraction = applied_n / kAppliedN.back();
  return force_from(applied_n + parameters.probe_resolution_n * (u - 0.5),
                    site.theta_rad + error.theta_rad + fraction * error.theta_play_rad,
                    site.phi_rad + error.phi_rad + fraction * error.phi_play_rad);
}

/// The sensor as calibrated for the direct solve; its noise includes rounding to whole counts.
PillarSensor calibrated(PillarSensor sensor) {
  sensor.noise_counts = std::hypot(sensor.noise_counts, 1 / std::sqrt(12.0));
  return sensor;
}

Trial measure(const PillarSensor& sensor, double applied_n, Force truth,
              std::span<const float, 4> noise) {
  const std::array<double, 4> raw = read_sensels(truth, sensor, noise);
  return {applied_n, truth, raw,
          estimate_pillar(raw, without_calibration(sensor), Estimator::paper),
          estimate_pillar(raw, calibrated(sensor), Estimator::direct)};
}

Series run_series(const Parameters& parameters, std::uint64_t run, std::uint32_t site) {
  const Misalignment error = misalignment_of(parameters, run, site);
  std::array<double, kAppliedN.size()> probe{};
  random::fill_uniform({parameters.seed, random::Stream::probe, run, site}, probe);
  std::array<float, 4 * kAppliedN.size()> noise{};
  random::fill_normal({parameters.seed, random::Stream::noise, run, site}, noise);
  Series series;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const Force truth = true_force(parameters, kSites[site], error, kAppliedN[i], probe[i]);
    series[i] = measure(parameters.sensor, kAppliedN[i], truth,
                        std::span<const float>(noise).subspan(4 * i).first<4>());
  }
  return series;
}

}  // namespace

void check(const Parameters& parameters) {
  const PillarSensor& sensor = parameters.sensor;
  require("sensitivity", sensor.counts_per_newton, kMinCountsPerNewton, kMaxCountsPerNewton);
  require("threshold", sensor.threshold_counts, 0, kMaxCounts);
  require("dead zone", sensor.dead_zone_counts, 0, kMaxCounts);
  require("full scale", sensor.full_scale_counts.value_or(1), 1, kMaxCounts);
  if (sensor.full_scale_counts && *sensor.full_scale_counts <= sensor.threshold_counts) {
    throw Error("testbed",
                fmt::format("the full scale {} leaves no reading above the threshold",
                            *sensor.full_scale_counts),
                fmt::format("give more than {}", sensor.threshold_counts));
  }
  require("noise", sensor.noise_counts, 0, kMaxNoiseCounts);
  require("accuracy of the positioner", parameters.positioner_rad, 0, 0.3);
  require("play", parameters.play_rad, 0, 0.3);
  require("resolution of the probe", parameters.probe_resolution_n, 0, 10);
}

double angle_uncertainty_rad(const Parameters& parameters) {
  return parameters.positioner_rad + parameters.play_rad;
}

Experiment run_experiment(const Parameters& parameters, std::uint64_t number) {
  Experiment run;
  for (std::uint32_t site = 0; site < run.size(); ++site) {
    run[site] = run_series(parameters, number, site);
  }
  return run;
}

Force force_from(double magnitude_n, double theta_rad, double phi_rad) {
  const double shear = magnitude_n * std::sin(theta_rad);
  return {-shear * std::cos(phi_rad), -shear * std::sin(phi_rad),
          magnitude_n * std::cos(theta_rad)};
}

std::array<double, 4> brackets(double theta_rad, double phi_rad) {
  const auto v = double_precision::model_readings(force_from(1, theta_rad, phi_rad), 1);
  return {v.v1, v.v2, v.v3, v.v4};
}

std::array<double, 4> read_sensels(Force force, const PillarSensor& sensor,
                                   std::span<const float, 4> noise) {
  const auto v = double_precision::model_readings(force, sensor.counts_per_newton);
  const std::array<double, 4> signal = {v.v1, v.v2, v.v3, v.v4};
  const double full_scale =
      sensor.full_scale_counts.value_or(std::numeric_limits<double>::infinity());
  std::array<double, 4> raw{};
  for (std::size_t n = 0; n < raw.size(); ++n) {
    const double response = std::max(0.0, signal[n] - sensor.dead_zone_counts);
    raw[n] = std::clamp(std::round(response + sensor.noise_counts * noise[n]), 0.0, full_scale);
  }
  return raw;
}

PillarSensor without_calibration(PillarSensor sensor) {
  sensor.dead_zone_counts = 0;
  sensor.noise_counts = 0;
  return sensor;
}

double unwrapped(double angle_rad, double centre_rad) {
  return centre_rad + std::remainder(angle_rad - centre_rad, 2 * std::numbers::pi);
}

}  // namespace pillarfield::testbed
