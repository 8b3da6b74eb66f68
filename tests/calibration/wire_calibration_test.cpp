// Resistance of wires from a body that rests while another one presses elsewhere.

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/wire_correction.h"
#include "pillarfield/calibration_steps.h"
#include "simulation/effects/wire_network.h"
#include "tests/base/message.h"
#include "tests/calibration/pressed_skin.h"

namespace pillarfield {
namespace {

using core_test::message_of;
using core_test::PressedSkin;

/// 32 x 32 sensels on wires; 10 kohm at 255 counts.
PressedSkin wired_skin(double row_ohm, double column_ohm, double noise_counts = 0.5,
                       TareOrigin tares = TareOrigin::conductance) {
  SensorModel sensor;
  sensor.tare_counts = 12;
  sensor.tare_spread_counts = 2;
  sensor.gain_spread = 0.05;
  sensor.noise_counts = noise_counts;
  if (row_ohm + column_ohm > 0) {
    const double count_siemens = 1 / (1e4 * 255);
    const double row = row_ohm * count_siemens;
    sensor.effects.wires = {64, 64, row, column_ohm * count_siemens, row, tares};
  }
  return {16, 16, sensor};
}

ClosedFormContact ball_at(double x_mm, double y_mm, double load_n) {
  ClosedFormContact ball;
  ball.contact_radius_mm = 4;
  ball.reference_load_n = load_n;
  ball.path = {{0, x_mm, y_mm, load_n}};
  return ball;
}

FrameStatistics under(PressedSkin& skin, std::vector<ClosedFormContact> contacts) {
  Scene scene = skin.scene();
  scene.load = std::move(contacts);
  return skin.statistics_of(Simulator(scene), 50);
}

std::vector<FrameStatistics> presses_of(PressedSkin& skin) {
  const ClosedFormContact rest = ball_at(-5, 5, 10);
  return {under(skin, {rest}), under(skin, {rest, ball_at(5, 5, 15)}),
          under(skin, {rest, ball_at(-5, -5, 15)}), under(skin, {rest, ball_at(5, -5, 15)})};
}

WireResult fitted(PressedSkin& skin, std::optional<TareOrigin> tares = std::nullopt) {
  const std::vector<FrameStatistics> presses = presses_of(skin);
  return calibrate_wires(blank_calibration(skin.skin()), presses, {64, 64}, tares);
}

TEST(WireCalibration, FindsTheResistancesAndHowTaresArise) {
  for (const TareOrigin origin : {TareOrigin::conductance, TareOrigin::offset}) {
    PressedSkin skin = wired_skin(60, 30, 0.5, origin);
    const WireResult result = fitted(skin);
    const WireCrosstalk truth = *skin.truth().effects.wires;
    EXPECT_TRUE(result.found);
    EXPECT_LT(result.standard_error.row_per_count, 0.05 * truth.row_per_count);
    EXPECT_GT(result.residual_before, 5 * result.residual_after);
    EXPECT_TRUE(result.calibration.planes.tare.empty());
    EXPECT_EQ(result.tares_shown, origin);
    EXPECT_NEAR(result.conducting_share, origin == TareOrigin::offset ? 0 : 1, 0.1);
    EXPECT_EQ(result.calibration.planes.effects.wires->tares, origin);
    EXPECT_NEAR(result.wires.row_per_count, truth.row_per_count, 0.05 * truth.row_per_count);
    EXPECT_NEAR(result.wires.column_per_count, truth.column_per_count, 0.05 * truth.row_per_count);
    EXPECT_EQ(fitted(skin, TareOrigin::offset).wires.tares, TareOrigin::offset);
  }
}

/// Tares of 12 counts that the converter adds to what the wires leave.
TEST(WireCorrection, TakesAnOffsetOffFirst) {
  Skin skin;
  skin.rows = skin.cols = 64;
  const double per_count = 50 / (1e4 * 200);
  const WireCrosstalk wires = {64, 64, per_count, per_count, per_count, TareOrigin::offset};
  FrameBuffer frame(SenselType::f32, 64, 64);
  std::vector<double> readings(std::size_t{64} * 64, 90);
  read_through_wires(wires, 64, 64, readings);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    frame.readings<float>()[i] = static_cast<float>(12 + readings[i]);
  }
  WireCorrection correct("p.h5", skin, SenselType::f32, wires,
                         std::vector<float>(std::size_t{64} * 64, 12));
  EXPECT_NEAR(static_cast<const float*>(correct(frame.view()).data)[0], 12 + 90, 0.05);
}

TEST(WireCorrection, RefusesRowsThatLoseTooMuch) {
  Skin skin;
  skin.rows = skin.cols = 64;
  const double per_count = 50 / (1e4 * 200);
  const WireCrosstalk wires = {64, 64, per_count, per_count, per_count};
  const auto correct = [&](double counts) {
    FrameBuffer frame(SenselType::f32, 64, 64);
    std::vector<double> readings(std::size_t{64} * 64, counts);
    read_through_wires(wires, 64, 64, readings);
    std::ranges::copy(readings, frame.readings<float>().begin());
    (void)WireCorrection("p240.h5", skin, SenselType::f32, wires, {})(frame.view());
  };
  EXPECT_NO_THROW(correct(120));
  EXPECT_EQ(
      message_of([&] { correct(240); }),
      "p240.h5: a row of sensels loses 27.7 % of its voltage in the wires, more than the 20 % "
      "that a calibration can correct; press less, or fewer sensels of a row at once");
}

/// Without noise the columns' resistance is exactly zero, with which that of idle rows has no
/// effect.
TEST(WireCalibration, StoresNothingWithoutResistance) {
  for (const double noise_counts : {0.5, 0.0}) {
    PressedSkin skin = wired_skin(0, 0, noise_counts);
    const WireResult result = fitted(skin);
    EXPECT_FALSE(result.calibration.planes.effects.wires);
    EXPECT_LT(result.wires.row_per_count, 4 * result.standard_error.row_per_count + 1e-12);
    EXPECT_LT(result.wires.column_per_count, 4 * result.standard_error.column_per_count + 1e-12);
  }
}

TEST(WireCalibration, RefusesWhatDoesNotTell) {
  PressedSkin skin = wired_skin(60, 30);
  const std::vector<FrameStatistics> presses = presses_of(skin);
  const SkinCalibration blank = blank_calibration(skin.skin());
  const auto message = [&](std::span<const FrameStatistics> files, const WireTile& tile) {
    return message_of([&] { (void)calibrate_wires(blank, files, tile); });
  };
  EXPECT_NE(message({presses.data(), 1}, {}).find("one file is too few"), std::string::npos);
  EXPECT_NE(message(presses, {1, 64}).find("tile_rows is 1"), std::string::npos);
  const std::vector<FrameStatistics> idle(2, under(skin, {}));
  EXPECT_FALSE(message(idle, {}).empty());
}

}  // namespace
}  // namespace pillarfield
