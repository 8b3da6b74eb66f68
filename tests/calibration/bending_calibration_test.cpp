// Patterns of bending from known cylinders.

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

PressedSkin bendable_skin(double spread_counts_mm) {
  SensorModel sensor;
  sensor.tare_counts = 40;
  sensor.gain_spread = 0.05;
  sensor.noise_counts = 0.5;
  PressedSkin skin(20, 20, sensor);
  if (spread_counts_mm > 0) skin.scene().bending = Bending{spread_counts_mm, {{}}};
  return skin;
}

FrameStatistics bent(PressedSkin& skin, const Curvature& curvature) {
  PressedSkin shape = skin;
  if (shape.scene().bending) {
    shape.scene().bending->path = {{0, curvature.x, curvature.y, curvature.xy}};
  }
  // Other frames than those of the tare, so other noise.
  (void)skin.bare(100);
  return shape.bare(100);
}

constexpr double kRadius = 60;

BendingResult bent_in_three_directions(PressedSkin& skin) {
  const SkinCalibration before = skin.tared();
  const Curvature along[] = {curvature_of_cylinder(kRadius, 90), curvature_of_cylinder(kRadius, 0),
                             curvature_of_cylinder(kRadius, 45),
                             curvature_of_cylinder(kRadius, -45)};
  std::vector<FrameStatistics> frames;
  for (const Curvature& curvature : along) frames.push_back(bent(skin, curvature));
  std::vector<BentSkin> shapes;
  for (std::size_t i = 0; i < frames.size(); ++i) shapes.push_back({frames[i], along[i]});
  return calibrate_bending(before, shapes);
}

TEST(BendingCalibration, FindsThePatterns) {
  PressedSkin skin = bendable_skin(300);
  const BendingResult result = bent_in_three_directions(skin);
  ASSERT_TRUE(result.found);
  const Calibration truth = skin.truth();
  const auto error = [](const std::vector<float>& found, const std::vector<float>& expected) {
    double squares = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      squares += (found[i] - expected[i]) * (found[i] - expected[i]);
    }
    return std::sqrt(squares / static_cast<double>(found.size()));
  };
  const Calibration& planes = result.calibration.planes;
  EXPECT_NEAR(error(planes.bend_x, truth.bend_x) / result.standard_error[0], 1, 0.25);
  EXPECT_NEAR(error(planes.bend_y, truth.bend_y) / result.standard_error[1], 1, 0.25);
  EXPECT_NEAR(error(planes.bend_xy, truth.bend_xy) / result.standard_error[2], 1, 0.25);
  EXPECT_LT(result.standard_error[0], 10);
  EXPECT_NEAR(result.rms[0], 300, 30);
  EXPECT_GT(result.residual_before, 3);
  EXPECT_LT(result.residual_after, 0.1);
}

TEST(BendingCalibration, StoresNothingIfTaresDoNotChange) {
  PressedSkin skin = bendable_skin(0);
  const BendingResult result = bent_in_three_directions(skin);
  EXPECT_FALSE(result.found);
  EXPECT_TRUE(result.calibration.planes.bend_x.empty());
  for (const int p : {0, 1, 2}) EXPECT_NEAR(result.rms[p] / result.standard_error[p], 1, 0.3);
}

TEST(BendingCalibration, ACylinderCurvesAcrossItsAxis) {
  const Curvature vertical = curvature_of_cylinder(50, 90);
  EXPECT_NEAR(vertical.x, 0.02, 1e-12);
  EXPECT_NEAR(vertical.y, 0, 1e-12);
  // The height falls as the square of the distance from the axis, here from x = y.
  const Curvature rising = curvature_of_cylinder(50, 45);
  const auto height = [&](double x, double y) {
    return -(rising.x * x * x + rising.y * y * y + rising.xy * x * y) / 2;
  };
  EXPECT_NEAR(height(3, 3), 0, 1e-12);
  EXPECT_NEAR(height(1, -1), -2 / 100.0, 1e-12);
}

TEST(BendingCalibration, RefusesWhatDoesNotTell) {
  PressedSkin skin = bendable_skin(300);
  const SkinCalibration before = skin.tared();
  const FrameStatistics frames = skin.bare(10);
  const Curvature x = curvature_of_cylinder(60, 90);
  const BentSkin twice[] = {{frames, x}, {frames, x}};
  EXPECT_NE(message_of([&] { (void)calibrate_bending(before, twice); }).find("do not determine"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              (void)calibrate_bending(before, {twice, 1});
            }).find("one shape"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              (void)calibrate_bending(blank_calibration(skin.skin()), twice);
            }).find("tare of the flat skin"),
            std::string::npos);
}

}  // namespace
}  // namespace pillarfield
