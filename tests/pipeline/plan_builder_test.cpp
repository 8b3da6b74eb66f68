#include "pillarfield/plan_builder.h"

#include <gtest/gtest.h>

namespace pillarfield {
namespace {

constexpr double kTimeS = 10;
constexpr double kIntervalS = 0.001;

Scene following_scene() {
  Scene scene;
  scene.rate_hz = 1 / kIntervalS;
  scene.baseline_time_s = kTimeS;
  return scene;
}

SolverPlan built(const PlanSources& from) {
  return build_plan({}, from, "a test", [] { return kIntervalS; });
}

TEST(BaselineOfPlans, HasOneIntervalHoweverItIsAskedFor) {
  const Scene scene = following_scene();
  SolverPlan of_scene;
  set_solver(of_scene, scene);
  EXPECT_GT(of_scene.baseline_interval, 50);
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

}  // namespace
}  // namespace pillarfield
