// Counts per newton and power laws from known loads.

#include <gtest/gtest.h>

#include <cmath>

#include "pillarfield/calibration_steps.h"
#include "pillarfield/host_solve.h"
#include "tests/base/message.h"
#include "tests/calibration/pressed_skin.h"

namespace pillarfield {
namespace {

using core_test::message_of;
using core_test::PressedSkin;

constexpr std::uint32_t kLoadFrames = 50;

SensorModel noisy_sensor() {
  SensorModel sensor;
  sensor.tare_counts = 12;
  sensor.tare_spread_counts = 1.5;
  sensor.noise_counts = 1;
  sensor.adc_bits = 12;
  return sensor;
}

/// A punch of 12 mm across in the middle of the skin.
FrameStatistics punched(PressedSkin& skin, double load_n) {
  Scene scene = skin.scene();
  ClosedFormContact punch;
  punch.shape = ContactShape::flat_punch;
  punch.contact_radius_mm = 6;
  punch.path = {{0, 0, 0, load_n}};
  scene.load = std::vector<ClosedFormContact>{punch};
  return skin.statistics_of(Simulator(scene), kLoadFrames);
}

TEST(LoadCalibration, AFlatPressGivesTheSensitivity) {
  PressedSkin skin(20, 20, noisy_sensor());
  skin.scene().skin.counts_per_newton = 250;
  const SkinCalibration before = skin.tared();
  const FrameStatistics press = skin.press(0.4, kLoadFrames);
  const KnownLoad loads[] = {{press, 400 * 0.4}};
  const LoadResult result = calibrate_load(before, loads, LoadModel::linear);
  // 1600 sensels with the noise of tare and press, over their sum.
  EXPECT_NEAR(result.calibration.counts_per_newton.value(), 250, 250 * 4 * 2e-4);
  EXPECT_EQ(result.loads[0].ambiguous_share, 0);
  EXPECT_NEAR(result.loads[0].solved_n, 160, 1e-9 * 160);
  EXPECT_NEAR(result.misfit, 0, 1e-9);
  EXPECT_DOUBLE_EQ(result.least_counts_per_newton, *result.calibration.counts_per_newton);
  EXPECT_DOUBLE_EQ(result.most_counts_per_newton, *result.calibration.counts_per_newton);
  EXPECT_FALSE(result.calibration.power_law);
}

TEST(LoadCalibration, SeveralLoadsShareTheirErrors) {
  PressedSkin skin(20, 20, noisy_sensor());
  const SkinCalibration before = skin.tared();
  const FrameStatistics light = punched(skin, 10);
  const FrameStatistics heavy = punched(skin, 40);
  // Both balances are wrong by two percent, one up and one down.
  const KnownLoad loads[] = {{light, 10 * 1.02}, {heavy, 40 / 1.02}};
  const LoadResult result = calibrate_load(before, loads, LoadModel::linear);
  EXPECT_NEAR(result.calibration.counts_per_newton.value(), 320, 320 * 0.01);
  EXPECT_NEAR(result.misfit, 0.02, 0.005);
  EXPECT_LT(result.loads[0].solved_n, loads[0].load_n);
  EXPECT_GT(result.loads[1].solved_n, loads[1].load_n);
}

TEST(LoadCalibration, MissingSenselsAreNoLoss) {
  PressedSkin skin(20, 20, noisy_sensor());
  SkinCalibration before = skin.tared();
  before.planes.mask.assign(skin.skin().sensels(), 1);
  for (std::size_t i = 0; i < before.planes.mask.size(); i += 14) before.planes.mask[i] = 0;
  const FrameStatistics press = skin.press(0.4, kLoadFrames);
  const KnownLoad loads[] = {{press, 160}};
  const LoadResult result = calibrate_load(before, loads, LoadModel::linear);
  EXPECT_NEAR(result.calibration.counts_per_newton.value(), 320, 320 * 1e-3);
}

TEST(LoadCalibration, ShearedPillarsGiveAnIntervalThatHoldsTheTruth) {
  PressedSkin skin(20, 20, noisy_sensor());
  const SkinCalibration before = skin.tared();
  Scene scene = skin.scene();
  ClosedFormContact slider;
  slider.contact_radius_mm = 8;
  slider.reference_load_n = 20;
  slider.motion = ContactMotion::slide;
  slider.friction = 1.6;
  slider.path = {{0, 0, 0, 20}};
  scene.load = std::vector<ClosedFormContact>{slider};
  const FrameStatistics sheared = skin.statistics_of(Simulator(scene), kLoadFrames);
  const KnownLoad loads[] = {{sheared, 20}};
  const LoadResult result = calibrate_load(before, loads, LoadModel::linear);
  EXPECT_GT(result.loads[0].ambiguous_share, 0.5);
  EXPECT_LT(result.least_counts_per_newton, 0.9 * 320);
  EXPECT_GT(result.most_counts_per_newton, 320);
}

/// A response of power 0.8 for which straight lines are fitted: loads in between have as large
/// errors as those of the calibration, and the deviations must say so.
TEST(LoadCalibration, WhatSeveralLoadsLeaveIsStated) {
  PressedSkin skin(20, 20, noisy_sensor());
  skin.scene().skin.power_law = {0.8, 100};
  const SkinCalibration before = skin.tared();
  const double forces_n[] = {0.2, 0.3, 0.4, 0.6};
  std::vector<FrameStatistics> frames;
  for (const double force_n : forces_n) frames.push_back(skin.press(force_n, kLoadFrames));
  std::vector<KnownLoad> loads;
  for (std::size_t i = 0; i < 4; ++i) loads.push_back({frames[i], 400 * forces_n[i]});
  const LoadResult result = calibrate_load(before, loads, LoadModel::linear);
  EXPECT_GT(result.misfit, 0.05);
  ASSERT_TRUE(result.calibration.planes.effects.residual);
  EXPECT_NEAR(result.calibration.planes.effects.residual->relative,
              result.misfit * std::sqrt(4.0 / 3), 1e-9);
  EXPECT_FALSE(calibrate_load(before, {loads.data(), 1}, LoadModel::linear)
                   .calibration.planes.effects.residual);

  int held = 0;
  for (const double force_n : {0.22, 0.35, 0.5, 0.58}) {
    const FrameBuffer mean = mean_frame(skin.press(force_n, 1));
    SolverPlan plan;
    plan.skin = skin.skin();
    plan.skin.power_law.reset();
    plan.sensel_type = SenselType::f32;
    plan.uncertainty = true;
    apply(result.calibration, plan.skin, plan.calibration);
    const ForceField solved = solve_on_host(plan, mean.view());
    const std::vector<float>& deviation = solved.uncertainty[Uncertainty::normal];
    for (std::size_t i = 0; i < solved.elements(); ++i) {
      held += std::abs(solved.normal[i] - force_n) < 1.96 * deviation[i] ? 1 : 0;
    }
  }
  EXPECT_GT(held, 0.93 * 4 * 400);
}

class PowerLawLoad : public testing::TestWithParam<double> {};

TEST_P(PowerLawLoad, TheExponentIsFound) {
  SensorModel sensor = noisy_sensor();
  sensor.tare_counts = 20;
  sensor.noise_counts = 0.5;
  PressedSkin skin(20, 20, sensor);
  skin.scene().skin.power_law = {GetParam(), 100};
  const SkinCalibration before = skin.tared();
  const FrameStatistics light = skin.press(0.1, kLoadFrames);  // 32 counts
  const FrameStatistics middle = skin.press(0.3, kLoadFrames);
  const FrameStatistics heavy = skin.press(0.7, kLoadFrames);  // 224 counts
  const KnownLoad loads[] = {{light, 40}, {middle, 120}, {heavy, 280}};
  const LoadResult result = calibrate_load(before, loads, LoadModel::power);
  const PowerLaw& law = result.calibration.power_law.value();
  EXPECT_NEAR(law.exponent, GetParam(), 2e-3 * GetParam());
  EXPECT_LT(result.misfit, 2e-3);
  // V = 320 N at the true reference: k and the new reference together must say the same.
  const double k = result.calibration.counts_per_newton.value();
  EXPECT_NEAR(straightened(law, 100) / k, 100 / 320.0, 1e-3 * 100 / 320);
  // The threshold is still at the same reading.
  EXPECT_NEAR(*result.calibration.threshold_counts, straightened(law, *before.threshold_counts),
              1e-9);
  const LoadResult linear = calibrate_load(result.calibration, loads, LoadModel::linear);
  EXPECT_FALSE(linear.calibration.power_law);
  EXPECT_NEAR(*linear.calibration.threshold_counts, *before.threshold_counts, 1e-9);
  EXPECT_TRUE(linear.misfit > 0.05 || GetParam() == 1) << linear.misfit;
}

INSTANTIATE_TEST_SUITE_P(Exponents, PowerLawLoad, testing::Values(0.7, 1.0, 1.4));

/// A sensel that was clipped now and then has too low a mean.
TEST(LoadCalibration, SaturationInSomeFramesIsSeen) {
  SensorModel sensor = noisy_sensor();
  sensor.adc_bits = 8;
  sensor.noise_counts = 6;
  PressedSkin skin(10, 10, sensor);
  const SkinCalibration before = skin.tared();
  const FrameStatistics press = skin.press(0.72, kLoadFrames);  // 242 counts with the tare
  const KnownLoad loads[] = {{press, 72}};
  const std::string message =
      message_of([&] { (void)calibrate_load(before, loads, LoadModel::linear); });
  EXPECT_NE(message.find("saturated"), std::string::npos) << message;
}

TEST(LoadCalibration, RefusesWhatDoesNotTell) {
  PressedSkin skin(10, 10, noisy_sensor());
  const SkinCalibration before = skin.tared();
  const FrameStatistics press = skin.press(0.4, kLoadFrames);
  const FrameStatistics bare = skin.bare(kLoadFrames);
  const FrameStatistics crushed = skin.press(100, kLoadFrames);
  const auto message = [&](std::vector<KnownLoad> loads, LoadModel model) {
    return message_of([&] { (void)calibrate_load(before, loads, model); });
  };
  const auto linear = LoadModel::linear;
  EXPECT_EQ(message({{press, 0}}, linear), "frames.h5: its load is 0 N; it must be above zero");
  EXPECT_NE(message({{press, std::nan("")}}, linear).find("nan N"), std::string::npos);
  EXPECT_NE(message({{bare, 5}}, linear).find("has no contact"), std::string::npos);
  EXPECT_NE(message({{crushed, 5}}, linear).find("saturated"), std::string::npos);
  EXPECT_NE(message({}, linear).find("no load"), std::string::npos);
  EXPECT_NE(message({{press, 40}}, LoadModel::power).find("40 to 40 N"), std::string::npos);
  EXPECT_NE(message({{press, 40}, {press, 400}}, LoadModel::power).find("is solved as"),
            std::string::npos);
}

}  // namespace
}  // namespace pillarfield
