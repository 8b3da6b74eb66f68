#include "pillarfield/solver_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pillarfield/error.h"
#include "solve/plan_settings.h"

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

TEST(SolverPlan, NumbersOutOfRangeAreRefused) {
  const auto refuses = [](auto&& spoil) {
    SolverPlan plan;
    plan.skin.rows = plan.skin.cols = 8;
    plan.sensel_type = SenselType::u8;
    EXPECT_NO_THROW(check(plan, "plan"));
    spoil(plan);
    EXPECT_THROW(check(plan, "plan"), Error);
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const PlanSetting& setting : kPlanSettings) {
    SolverPlan plan;
    setting.number.set(plan, setting.range.low);
    if (!setting.number.get(plan)) continue;  // build_plan() applies it.
    SCOPED_TRACE(setting.name);
    for (const double wrong :
         {setting.range.low - 1, setting.range.high * 1.01, kInfinity, std::nan("")}) {
      refuses([&](SolverPlan& spoilt) { setting.number.set(spoilt, wrong); });
    }
  }
  for (const double wrong : {-1.0, 0.0, 1.01, std::nan("")}) {
    refuses([&](SolverPlan& plan) { plan.segment_point = wrong; });
    refuses([&](SolverPlan& plan) { plan.baseline_rate = wrong; });
    refuses([&](SolverPlan& plan) { plan.friction.spread = wrong == 1.01 ? 100 : wrong; });
  }
  refuses([](SolverPlan& plan) { plan.skin.rows = 1; });
  refuses([](SolverPlan& plan) { plan.skin.cols = 70000; });
  refuses([](SolverPlan& plan) { plan.skin.power_law = PowerLaw{0, 1}; });
  refuses([](SolverPlan& plan) { plan.uncertainty = true; });  // without noise
  refuses([](SolverPlan& plan) {
    plan.uncertainty = true;
    plan.noise_counts = 1;
    plan.estimator = Estimator::paper;
  });
  refuses([](SolverPlan& plan) { plan.calibration.noise.assign(64, -1.0F); });
  refuses([](SolverPlan& plan) { plan.calibration.tare = {1, 2}; });
  refuses([](SolverPlan& plan) { plan.calibration.gain.assign(64, 0.0F); });
  refuses([](SolverPlan& plan) { plan.calibration.dead_zone.assign(64, std::nanf("")); });
  refuses([](SolverPlan& plan) { plan.calibration.mask.assign(64, 3); });
  refuses([](SolverPlan& plan) {  // the loading curve falls
    plan.calibration.effects.memory.emplace().plays = {{3, -0.5}, {5, -0.5}};
  });
}

}  // namespace
}  // namespace pillarfield
