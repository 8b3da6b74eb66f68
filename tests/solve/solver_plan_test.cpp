#include "pillarfield/solver_plan.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(BaselineInterval, IsShortBesideBothTimesAndNoPeriodOfHum) {
  struct Case {
    double time_constant_s;
    double rate_hz;
    int interval;
  };
  for (const Case& each :
       {Case{1, 100, 1}, Case{10, 100, 1}, Case{2, 500, 7}, Case{10, 500, 11}, Case{10, 1000, 23},
        Case{60, 1000, 23}, Case{1e-3, 30, 1}, Case{1e9, 1000, 23}}) {
    SolverPlan plan;
    plan.frame_interval_s = 1 / each.rate_hz;
    set_baseline(plan, each.time_constant_s);
    EXPECT_EQ(plan.baseline_interval, each.interval) << each.time_constant_s << each.rate_hz;
    EXPECT_NEAR(*plan.baseline_rate, -std::expm1(-1 / (each.rate_hz * each.time_constant_s)),
                1e-15);
  }
}

}  // namespace
}  // namespace pillarfield
