// The arm of off-centre pressure from indenters pressed straight down.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "pillarfield/calibration_steps.h"
#include "pillarfield/tare.h"
#include "tests/base/message.h"
#include "tests/calibration/pressed_skin.h"

namespace pillarfield {
namespace {

using core_test::message_of;
using core_test::PressedSkin;

PressedSkin leaning_skin(const std::optional<double>& arm_mm, double noise_counts = 0.5) {
  SensorModel sensor;
  sensor.effects.arm_mm = arm_mm;
  sensor.noise_counts = noise_counts;
  PressedSkin skin(40, 40, sensor);
  skin.scene().skin.counts_per_newton = 160;
  skin.scene().skin.threshold_counts = 2;
  return skin;
}

/// Frames under four balls, pressed down at different places within a pillar.
FrameStatistics balls(PressedSkin& skin, double radius_mm, double load_n) {
  Scene scene = skin.scene();
  std::vector<ClosedFormContact> contacts;
  const double places[][2] = {{-11.3, -10.2}, {11.6, -9.7}, {-10.1, 11.4}, {10.5, 10.9}};
  for (const auto& [x, y] : places) {
    ClosedFormContact indenter;
    indenter.shape = ContactShape::sphere;
    indenter.motion = ContactMotion::press;
    indenter.contact_radius_mm = radius_mm;
    indenter.reference_load_n = load_n;
    indenter.path = {{0, x, y, load_n}};
    contacts.push_back(indenter);
  }
  scene.load = contacts;
  return skin.statistics_of(Simulator(scene), 20);
}

ArmResult calibrated_arm(PressedSkin& skin, double radius_mm = 6, double load_n = 60) {
  const SkinCalibration before = skin.tared();
  const FrameStatistics presses[] = {balls(skin, radius_mm, load_n)};
  return calibrate_arm(before, presses);
}

/// The stated error covers what the polynomial of the lean leaves.
TEST(CalibrateArm, RecoversItWithinItsStatedError) {
  for (const double arm_mm : {0.224, 0.5, 2.0}) {
    for (const double radius_mm : {4.0, 6.0, 8.0}) {
      PressedSkin skin = leaning_skin(arm_mm);
      const ArmResult result = calibrated_arm(skin, radius_mm, 1.6 * radius_mm * radius_mm);
      ASSERT_TRUE(result.found);
      EXPECT_EQ(result.places, 4U);
      EXPECT_LT(result.standard_error, 0.07);
      EXPECT_NEAR(result.arm_mm / arm_mm, 1, 2 * result.standard_error) << arm_mm;
      EXPECT_EQ(result.calibration.planes.effects.arm_mm, result.arm_mm);
      EXPECT_LT(result.shear_after_n, 0.3 * result.shear_before_n);
    }
  }
}

TEST(CalibrateArm, ReplacesAnEarlierArmAndKeepsTheRest) {
  PressedSkin skin = leaning_skin(0.5);
  SkinCalibration before = skin.tared();
  before.planes.effects.arm_mm = 0.1;
  before.planes.effects.residual = {0.001, 0};
  const FrameStatistics presses[] = {balls(skin, 6, 60), balls(skin, 8, 100)};
  const ArmResult result = calibrate_arm(before, presses);
  EXPECT_EQ(result.places, 8U);
  EXPECT_NEAR(result.arm_mm, 0.5, 0.03);
  EXPECT_EQ(result.calibration.planes.tare, before.planes.tare);
  EXPECT_TRUE(result.calibration.planes.effects.residual.has_value());
}

/// Shear of a coefficient other than 1 is solved before it is compared with the lean.
TEST(CalibrateArm, FollowsTheShearCoefficient) {
  PressedSkin skin = leaning_skin(0.5);
  skin.scene().sensor.effects.shear_coefficient = {0.8, 0.8};
  SkinCalibration before = skin.tared();
  before.planes.effects.shear_coefficient = {0.8, 0.8};
  const FrameStatistics presses[] = {balls(skin, 6, 60)};
  EXPECT_NEAR(calibrate_arm(before, presses).arm_mm, 0.5, 0.03);
}

TEST(CalibrateArm, StoresNoneWherePillarsDoNotLean) {
  PressedSkin skin = leaning_skin(std::nullopt);
  const ArmResult result = calibrated_arm(skin);
  EXPECT_FALSE(result.found);
  EXPECT_GT(result.longest_mm, 20);
  EXPECT_FALSE(result.calibration.planes.effects.arm_mm.has_value());
  EXPECT_EQ(result.shear_after_n, result.shear_before_n);
}

TEST(CalibrateArm, RefusesWhatSaysTooLittle) {
  const auto says = [](PressedSkin skin, double radius_mm, double load_n, const char* what) {
    const std::string message =
        message_of([&] { static_cast<void>(calibrated_arm(skin, radius_mm, load_n)); });
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  says(leaning_skin(0.5), 2, 1, "standard error");
  says(leaning_skin(0.5, 20), 6, 20, "four usable sensels");
  PressedSkin skin = leaning_skin(0.5);
  const FrameStatistics presses[] = {balls(skin, 6, 60)};
  const std::string message = message_of(
      [&] { static_cast<void>(calibrate_arm(blank_calibration(skin.skin()), presses)); });
  EXPECT_NE(message.find("no tare"), std::string::npos) << message;
}

/// An image of the skin turned by half a circle leans the wrong way.
TEST(CalibrateArm, RefusesALeanAwayFromThePressure) {
  PressedSkin skin = leaning_skin(0.5);
  const SkinCalibration before = skin.tared();
  const FrameStatistics upright = balls(skin, 6, 60);
  const Skin& of = skin.skin();
  FrameStatistics turned("turned.h5", of, SenselType::f32);
  FrameBuffer frame(SenselType::f32, of.rows, of.cols);
  auto* values = reinterpret_cast<float*>(frame.bytes().data());
  for (std::uint32_t row = 0; row < of.rows; ++row) {
    for (std::uint32_t col = 0; col < of.cols; ++col) {
      // Each pillar stays in its place, its sensels trade theirs.
      const std::size_t from = std::size_t{row ^ 1U} * of.cols + (col ^ 1U);
      values[std::size_t{row} * of.cols + col] = static_cast<float>(upright.sensels()[from].mean);
    }
  }
  turned.add(frame.view());
  const FrameStatistics presses[] = {turned};
  const std::string message =
      message_of([&] { static_cast<void>(calibrate_arm(before, presses)); });
  EXPECT_NE(message.find("lean away"), std::string::npos) << message;
}

}  // namespace
}  // namespace pillarfield
