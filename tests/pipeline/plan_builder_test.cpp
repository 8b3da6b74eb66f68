#include "pillarfield/plan_builder.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pillarfield {
namespace {

constexpr double kTimeS = 10;
constexpr double kIntervalS = 0.001;

Scene following_scene() {
  Scene scene;
  scene.rate_hz = 1 / kIntervalS;
  scene.solver.baseline_time_s = kTimeS;
  return scene;
}

SolverPlan built(const PlanSources& from) {
  return build_plan({}, from, "a test", [] { return kIntervalS; });
}

TEST(BaselineOfPlans, HasOneIntervalHoweverItIsAskedFor) {
  const Scene scene = following_scene();
  SolverPlan of_scene;
  set_solver(of_scene, scene);
  EXPECT_GT(of_scene.baseline_interval, 20);
  PlanSettings time;
  time.baseline_time_s = kTimeS;
  PlanSettings everything;
  everything.everything = true;
  for (const PlanSources& from :
       {PlanSources{.scene = &scene}, {.settings = time}, {.settings = everything}}) {
    const SolverPlan plan = built(from);
    EXPECT_EQ(plan.baseline_interval, of_scene.baseline_interval);
    EXPECT_EQ(plan.baseline_rate, of_scene.baseline_rate);
  }
}

TEST(BaselineOfPlans, KeepsAGivenInterval) {
  const Scene scene = following_scene();
  PlanSettings settings;
  settings.baseline_interval = 3;
  for (const bool everything : {false, true}) {
    settings.everything = everything;
    EXPECT_EQ(built({.scene = &scene, .settings = settings}).baseline_interval, 3);
  }
}

TEST(ThresholdOfPlans, IsFourDeviationsWhereTheNoiseAloneIsKnown) {
  SkinCalibration calibration;
  calibration.planes.noise = {1, 1, 2, 1};
  calibration.planes.gain = {1, 1, 1.5, 1};
  calibration.rows = calibration.cols = 2;
  Scene scene;
  scene.skin.rows = scene.skin.cols = 2;
  scene.sensor.noise_counts = 0.5;
  const double rounding = 1.0 / 12;  // of readings of 8 bits
  const auto settings = [](std::optional<double> noise, std::optional<double> threshold) {
    PlanSettings given;
    given.noise_counts = noise;
    given.threshold_counts = threshold;
    return given;
  };
  struct Case {
    const char* name = "";
    PlanSources from = {};
    double threshold = 0;
  };
  const Case cases[] = {
      {"nothing", {}, 0},
      {"--noise", {.settings = settings(1, {})}, 4 * std::sqrt(1 + rounding)},
      {"a scene", {.scene = &scene}, 4 * std::sqrt(0.25 + rounding)},
      {"a calibration", {.calibration = &calibration}, 12},
      {"a given threshold", {.calibration = &calibration, .settings = settings({}, 0)}, 0},
      {"a given threshold above zero", {.settings = settings(1, 3)}, 3},
  };
  for (const Case& each : cases) {
    SolverPlan plan;
    plan.skin.rows = plan.skin.cols = 2;
    plan.sensel_type = SenselType::u8;
    plan = build_plan(plan, each.from, "a test", [] { return kIntervalS; });
    EXPECT_NEAR(plan.skin.threshold_counts, each.threshold, 1e-6) << each.name;
  }
}

}  // namespace
}  // namespace pillarfield
