#include "pillarfield/solver_plan.h"

#include <gtest/gtest.h>

namespace pillarfield {
namespace {

TEST(ReadingNoise, OfThePlaneElseOfThePlanElseAFourthOfTheThreshold) {
  SolverPlan plan;
  plan.skin.rows = 2;
  plan.skin.cols = 4;
  plan.skin.counts_per_newton = 100;
  plan.skin.threshold_counts = 6;
  plan.sensel_type = SenselType::f32;
  EXPECT_DOUBLE_EQ(reading_noise_n(plan), 0.015);
  plan.noise_counts = 3;
  EXPECT_DOUBLE_EQ(reading_noise_n(plan), 0.03);
  plan.calibration.noise.assign(8, 2);
  EXPECT_DOUBLE_EQ(reading_noise_n(plan), 0.02);
  plan.noise_counts.reset();
  EXPECT_DOUBLE_EQ(reading_noise_n(plan), 0.02);
  plan.calibration.effects.residual = {0.1, 1.5};
  EXPECT_DOUBLE_EQ(reading_noise_n(plan), 0.025);
}

}  // namespace
}  // namespace pillarfield
