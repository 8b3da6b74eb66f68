// Shear coefficients from known tangential loads.

#include <gtest/gtest.h>

#include <cmath>

#include "pillarfield/calibration_steps.h"
#include "pillarfield/tare.h"
#include "tests/base/message.h"
#include "tests/calibration/pressed_skin.h"

namespace pillarfield {
namespace {

using core_test::message_of;
using core_test::PressedSkin;

constexpr double kLoadN = 120;
constexpr double kFriction = 0.25;

PressedSkin noisy_skin() {
  SensorModel sensor;
  sensor.tare_counts = 12;
  sensor.gain_spread = 0.05;
  sensor.noise_counts = 0.5;
  return {20, 20, sensor};
}

SkinCalibration equilibrated(PressedSkin& skin) {
  const SkinCalibration tared = skin.tared();
  return skin.equilibrated(tared, {0.3}).calibration;
}

/// Frames under a flat indenter that is pulled by kLoadN · kFriction. Pillars whose coefficients
/// are c read it as the shear c · force, which is the friction kFriction · c.
FrameStatistics pulled(PressedSkin& skin, double direction_deg, double c) {
  Scene scene = skin.scene();
  ClosedFormContact indenter;
  indenter.shape = ContactShape::flat_punch;
  indenter.motion = ContactMotion::slide;
  indenter.friction = kFriction * c;
  indenter.direction_deg = direction_deg;
  indenter.contact_radius_mm = 9;
  indenter.path = {{0, 0, 0, kLoadN}};
  scene.load = std::vector<ClosedFormContact>{indenter};
  return skin.statistics_of(Simulator(scene), 50);
}

/// The shear on the skin as the simulator draws it: an indenter that slides right pulls it right.
ShearResult calibrated(PressedSkin& skin, double c_x, double c_y) {
  const SkinCalibration before = equilibrated(skin);
  const FrameStatistics right = pulled(skin, 0, c_x);
  const FrameStatistics left = pulled(skin, 180, c_x);
  const FrameStatistics up = pulled(skin, 90, c_y);
  const FrameStatistics down = pulled(skin, 270, c_y);
  const double shear = kLoadN * kFriction;
  const KnownShear loads[] = {
      {right, shear, 0}, {left, -shear, 0}, {up, 0, shear}, {down, 0, -shear}};
  return calibrate_shear(before, loads);
}

TEST(ShearCalibration, FindsBothCoefficients) {
  PressedSkin skin = noisy_skin();
  const ShearResult result = calibrated(skin, 1.1, 0.9);
  EXPECT_NEAR(result.coefficient.x, 1.1, 0.01);
  EXPECT_NEAR(result.coefficient.y, 0.9, 0.01);
  EXPECT_LT(std::abs(result.coefficient.x - 1.1), 4 * result.standard_error.x);
  EXPECT_LT(std::abs(result.coefficient.y - 0.9), 4 * result.standard_error.y);
  EXPECT_LT(result.standard_error.x, 0.01);
  const auto& stored = result.calibration.planes.effects.shear_coefficient;
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->x, result.coefficient.x);
  EXPECT_NEAR(result.loads[0].shear_x_n, kLoadN * kFriction, 0.5);
}

TEST(ShearCalibration, StoresNothingForTheIdealPillar) {
  PressedSkin skin = noisy_skin();
  const ShearResult result = calibrated(skin, 1, 1);
  EXPECT_NEAR(result.coefficient.x, 1, 3 * result.standard_error.x);
  EXPECT_NEAR(result.coefficient.y, 1, 3 * result.standard_error.y);
}

/// One axis serves for both.
TEST(ShearCalibration, AKnownNormalForceCancelsAnErrorOfTheSensitivity) {
  PressedSkin skin = noisy_skin();
  SkinCalibration before = equilibrated(skin);
  *before.counts_per_newton *= 1.07;
  const FrameStatistics up = pulled(skin, 90, 1.2);
  const KnownShear alone[] = {{up, 0, kLoadN * kFriction}};
  EXPECT_NEAR(calibrate_shear(before, alone).coefficient.y, 1.2 / 1.07, 0.02);
  const KnownShear with_normal[] = {{up, 0, kLoadN * kFriction, kLoadN}};
  const ShearResult result = calibrate_shear(before, with_normal);
  EXPECT_NEAR(result.coefficient.y, 1.2, 0.02);
  EXPECT_EQ(result.coefficient.x, result.coefficient.y);
}

TEST(ShearCalibration, RefusesWhatDoesNotTell) {
  PressedSkin skin = noisy_skin();
  const SkinCalibration before = equilibrated(skin);
  const FrameStatistics right = pulled(skin, 0, 1);
  const FrameStatistics bare = skin.bare(10);
  const auto message = [&](const SkinCalibration& calibration, const KnownShear& load) {
    return message_of([&] { (void)calibrate_shear(calibration, {&load, 1}); });
  };
  EXPECT_NE(message(before, {right, 0, 0}).find("all loads are zero"), std::string::npos);
  EXPECT_NE(message(before, {right, -30, 0}).find("signs of the loads"), std::string::npos);
  EXPECT_NE(message(before, {bare, 30, 0}).find("has no contact"), std::string::npos);
  EXPECT_NE(message(blank_calibration(skin.skin()), {right, 30, 0}).find("counts per newton"),
            std::string::npos);
  EXPECT_NE(message(before, {right, std::nan(""), 0}).find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace pillarfield
