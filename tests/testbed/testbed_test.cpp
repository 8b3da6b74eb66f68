#include "testbed/testbed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pillarfield/error.h"

namespace pillarfield::testbed {
namespace {

using std::numbers::pi;

/// An ideal sensor; readings match the model within 1e-6 of the force.
Parameters ideal() {
  Parameters parameters;
  parameters.sensor = PillarSensor{};
  parameters.sensor.counts_per_newton = 1e6;
  parameters.positioner_rad = 0;
  parameters.play_rad = 0;
  parameters.probe_resolution_n = 0;
  return parameters;
}

/// Direction of a force, written independently.
struct Origin {
  double magnitude;
  double theta;
  double phi;
};

Origin origin_of(const Force& force) {
  const double magnitude = std::sqrt(force.shear_x * force.shear_x + force.shear_y * force.shear_y +
                                     force.normal * force.normal);
  return {magnitude, std::acos(force.normal / magnitude),
          std::fmod(std::atan2(-force.shear_y, -force.shear_x) + 2 * pi, 2 * pi)};
}

TEST(Testbed, AppliesTheForcesOfThePaper) {
  const Experiment run = run_experiment(ideal(), 0);
  for (std::size_t site = 0; site < run.size(); ++site) {
    for (std::size_t i = 0; i < run[site].size(); ++i) {
      const Trial& trial = run[site][i];
      EXPECT_EQ(trial.applied_n, 10.0 * static_cast<double>(i + 1));
      const Origin truth = origin_of(trial.truth);
      EXPECT_NEAR(truth.magnitude, trial.applied_n, 1e-12);
      EXPECT_NEAR(truth.theta, kSites[site].theta_rad, 1e-12);
      EXPECT_NEAR(truth.phi, kSites[site].phi_rad, 1e-12);
    }
  }
}

TEST(Testbed, BothEstimatorsAreExactForAnIdealSensor) {
  for (const Series& series : run_experiment(ideal(), 0)) {
    for (const Trial& trial : series) {
      for (const Estimate& estimate : {trial.paper, trial.direct}) {
        EXPECT_NEAR(estimate.force.shear_x, trial.truth.shear_x, 1e-5);
        EXPECT_NEAR(estimate.force.shear_y, trial.truth.shear_y, 1e-5);
        EXPECT_NEAR(estimate.force.normal, trial.truth.normal, 1e-5);
      }
    }
  }
}

TEST(Testbed, ReadingsAreEquationTwoBehindTheDeadZone) {
  PillarSensor sensor;
  sensor.counts_per_newton = 20;
  sensor.dead_zone_counts = 100;
  sensor.full_scale_counts = 1000;
  const std::array<float, 4> no_noise = {};
  for (const double theta : {0.0, 0.4, 0.9, 1.3}) {
    for (const double phi : {0.1, 1.9, 4.0, 6.2}) {
      const auto raw = read_sensels(force_from(40, theta, phi), sensor, no_noise);
      for (int n = 1; n <= 4; ++n) {
        const double v =
            800 * (std::cos(theta) - std::sin(theta) * std::cos(pi / 4 * (2 * n - 1) - phi));
        const double expected = std::clamp(v - 100, 0.0, 1000.0);
        const double found = raw.at(static_cast<std::size_t>(n - 1));
        EXPECT_NEAR(found, expected, 0.5 + 1e-9);
        EXPECT_EQ(found, std::floor(found)) << "not a whole count";
      }
    }
  }
}

TEST(Testbed, NoiseIsAddedBehindTheDeadZoneAndNeverReadsBelowZero) {
  PillarSensor sensor;
  sensor.counts_per_newton = 20;
  sensor.dead_zone_counts = 100;
  sensor.noise_counts = 10;
  const std::array<float, 4> noise = {1, -1, 2, -2};
  const Force hidden = force_from(1, 0, 0);
  EXPECT_EQ(read_sensels(hidden, sensor, noise), (std::array<double, 4>{10, 0, 20, 0}));
  const Force pressing = force_from(20, 0, 0);
  EXPECT_EQ(read_sensels(pressing, sensor, noise), (std::array<double, 4>{310, 290, 320, 280}));
}

TEST(Testbed, TruthStaysWithinTheErrorsOfTheProbe) {
  const Parameters parameters;
  EXPECT_NEAR(angle_uncertainty_rad(parameters), 0.05, 1e-12);
  double farthest = 0;
  for (std::uint64_t number = 0; number < 300; ++number) {
    const Experiment run = run_experiment(parameters, number);
    for (std::size_t site = 0; site < run.size(); ++site) {
      const Origin first = origin_of(run[site].front().truth);
      for (const Trial& trial : run[site]) {
        const Origin truth = origin_of(trial.truth);
        const double theta_error = truth.theta - kSites[site].theta_rad;
        const double phi_error = truth.phi - kSites[site].phi_rad;
        EXPECT_NEAR(truth.magnitude, trial.applied_n, 0.05 + 1e-9);
        EXPECT_LE(std::abs(theta_error), 0.05);
        EXPECT_LE(std::abs(phi_error), 0.05);
        EXPECT_LE(std::abs(truth.theta - first.theta), 0.01) << "play";
        EXPECT_LE(std::abs(truth.phi - first.phi), 0.01) << "play";
        farthest = std::max({farthest, std::abs(theta_error), std::abs(phi_error)});
      }
    }
  }
  EXPECT_GT(farthest, 0.045) << "the errors do not reach their bounds";
}

TEST(Testbed, RunsAreReproducibleAndIndependent) {
  const Parameters parameters;
  Parameters other = parameters;
  other.seed = 2;
  const auto raw = [](const Experiment& run) { return run[1][4].raw; };
  const auto truth = [](const Experiment& run) { return run[1][4].truth.normal; };
  EXPECT_EQ(raw(run_experiment(parameters, 7)), raw(run_experiment(parameters, 7)));
  EXPECT_NE(truth(run_experiment(parameters, 7)), truth(run_experiment(parameters, 8)));
  EXPECT_NE(truth(run_experiment(parameters, 7)), truth(run_experiment(other, 7)));
}

TEST(Testbed, PaperIgnoresTheDeadZone) {
  Parameters parameters = ideal();
  parameters.sensor.dead_zone_counts = 3e6;
  // All sensels of region 1 lose 3 N: the shear is exact, the normal force 3 N short.
  const Trial trial = run_experiment(parameters, 0)[0].back();
  EXPECT_NEAR(trial.paper.force.shear_x, trial.truth.shear_x, 1e-5);
  EXPECT_NEAR(trial.paper.force.normal, trial.truth.normal - 3, 1e-5);
  EXPECT_NEAR(trial.direct.force.normal, trial.truth.normal, 1e-5);
}

TEST(Testbed, AnglesAreUnwrapped) {
  EXPECT_NEAR(unwrapped(-0.5, 6.0), 2 * pi - 0.5, 1e-12);
  EXPECT_NEAR(unwrapped(6.2, 0.1), 6.2 - 2 * pi, 1e-12);
  EXPECT_NEAR(unwrapped(3.0, 3.1), 3.0, 1e-12);
}

TEST(Testbed, ParametersOutOfRangeAreNamed) {
  using P = Parameters;
  using Change = void (*)(P&, double);
  const auto error_with = [](Change change, double value) -> std::string {
    P parameters;
    change(parameters, value);
    try {
      check(parameters);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::pair<const char*, Change> changes[] = {
      {"sensitivity", [](P& p, double value) { p.sensor.counts_per_newton = value; }},
      {"dead zone", [](P& p, double value) { p.sensor.dead_zone_counts = value; }},
      {"threshold", [](P& p, double value) { p.sensor.threshold_counts = value; }},
      {"noise", [](P& p, double value) { p.sensor.noise_counts = value; }},
      {"full scale", [](P& p, double value) { p.sensor.full_scale_counts = value; }},
      {"positioner", [](P& p, double value) { p.positioner_rad = value; }},
      {"play", [](P& p, double value) { p.play_rad = value; }},
      {"probe", [](P& p, double value) { p.probe_resolution_n = value; }}};
  EXPECT_NO_THROW(check(P{}));
  for (const auto& [name, change] : changes) {
    for (const double wrong : {-1.0, 1e40, std::numeric_limits<double>::quiet_NaN()}) {
      EXPECT_NE(error_with(change, wrong).find(name), std::string::npos) << name << ' ' << wrong;
    }
  }
  EXPECT_NE(error_with(changes[4].second, P{}.sensor.threshold_counts).find("full scale"),
            std::string::npos);
}

}  // namespace
}  // namespace pillarfield::testbed
