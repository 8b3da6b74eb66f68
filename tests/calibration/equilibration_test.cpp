// Equilibration: gains, dead zones and counts per newton from uniform pressure.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pillarfield/calibration_steps.h"
#include "pillarfield/tare.h"
#include "tests/base/message.h"
#include "tests/calibration/pressed_skin.h"

namespace pillarfield {
namespace {

using core_test::message_of;
using core_test::PressedSkin;

constexpr std::uint32_t kFrames = 100;

/// One count of noise, 10 % of gain spread; readings of whole counts.
SensorModel spread_sensor() {
  SensorModel sensor;
  sensor.tare_counts = 12;
  sensor.tare_spread_counts = 1.5;
  sensor.gain_spread = 0.1;
  sensor.noise_counts = 1;
  sensor.adc_bits = 12;
  return sensor;
}

const double kNoise = std::sqrt(1 + 1 / 12.0);

double mean_of(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The largest and the root mean square of |found / expected − 1|.
struct Errors {
  double largest = 0;
  double rms = 0;
};
Errors relative_errors(const std::vector<float>& found, const std::vector<float>& expected,
                       double scale) {
  Errors errors;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double error = std::abs(found[i] / (scale * expected[i]) - 1);
    errors.largest = std::max(errors.largest, error);
    errors.rms += error * error / static_cast<double>(found.size());
  }
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

TEST(Equilibration, OnePressureGivesGainsToOnePercent) {
  PressedSkin skin(40, 40, spread_sensor());
  const SkinCalibration before = skin.tared();
  const EquilibrationResult result = skin.equilibrated(before, {0.4});  // 128 counts
  const std::vector<float>& gain = result.calibration.planes.gain;
  const Calibration truth = skin.truth();
  EXPECT_NEAR(mean_of(gain), 1, 1e-6);
  const double share = 1 / mean_of(truth.gain);
  const Errors errors = relative_errors(gain, truth.gain, share);
  EXPECT_LT(errors.largest, 0.01);
  // The tare and the press have the same error, kNoise / 10, of 128 counts over the gain.
  EXPECT_NEAR(errors.rms, std::sqrt(2.0) * 0.1 * kNoise / 128, 0.1e-3);
  // The skin's k, and what the mean of the gains takes from it.
  EXPECT_NEAR(result.calibration.counts_per_newton.value() / (320 * share), 1, 1e-3);
  EXPECT_NEAR(result.gain_spread, 0.1, 0.01);
  EXPECT_EQ(result.levels, 1U);
  EXPECT_TRUE(result.calibration.planes.dead_zone.empty());
  EXPECT_TRUE(result.findings.empty());
  EXPECT_LT(result.unevenness, 0.02);
}

TEST(Equilibration, TwoPressuresGiveTheDeadZoneToo) {
  SensorModel sensor = spread_sensor();
  sensor.dead_zone_counts = 4;
  PressedSkin skin(40, 40, sensor);
  const SkinCalibration before = skin.tared();
  const EquilibrationResult result = skin.equilibrated(before, {0.2, 0.7});  // 64, 224 counts
  const Calibration truth = skin.truth();
  const double share = 1 / mean_of(truth.gain);
  const Errors errors = relative_errors(result.calibration.planes.gain, truth.gain, share);
  EXPECT_LT(errors.largest, 0.01);
  EXPECT_NEAR(errors.rms, std::sqrt(2.0) * 0.1 * kNoise / 160, 0.1e-3);
  EXPECT_NEAR(mean_of(result.calibration.planes.gain), 1, 1e-6);
  // docs/calibration.md: the variance of z, at gain 1 and with the tare's own.
  const double z_error = 0.1 * kNoise * std::sqrt(0.5 + 140 * 140 / (160.0 * 160 / 2) + 1);
  double squares = 0;
  for (const float z : result.calibration.planes.dead_zone) {
    EXPECT_NEAR(z, 4 * share, 6 * z_error);
    squares += (z - 4 * share) * (z - 4 * share);
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(truth.gain.size())), z_error, 0.1 * z_error);
  EXPECT_NEAR(result.dead_zone_counts, 4 * share, 0.02);
  EXPECT_NEAR(result.calibration.counts_per_newton.value() / (320 * share), 1, 1e-3);
  EXPECT_EQ(result.levels, 2U);
}

TEST(Equilibration, AKnownDeadZoneServesWithOnePressure) {
  SensorModel sensor = spread_sensor();
  sensor.dead_zone_counts = 8;
  PressedSkin skin(20, 20, sensor);
  SkinCalibration before = skin.tared();
  before.planes.dead_zone.assign(skin.skin().sensels(), 8);
  const EquilibrationResult result = skin.equilibrated(before, {0.3});
  const Calibration truth = skin.truth();
  const double share = 1 / mean_of(truth.gain);
  EXPECT_LT(relative_errors(result.calibration.planes.gain, truth.gain, share).largest, 0.01);
  EXPECT_EQ(result.calibration.planes.dead_zone, before.planes.dead_zone);
  // (V - z) share + z at 96 counts.
  EXPECT_NEAR(result.calibration.counts_per_newton.value(), (88 * share + 8) / 0.3, 0.5);
  EXPECT_NEAR(mean_of(result.calibration.planes.gain), 1, 1e-6);
}

TEST(Equilibration, DeadAndSaturatedSenselsAreMasked) {
  SensorModel sensor = spread_sensor();
  sensor.dead_share = 0.02;
  PressedSkin skin(20, 20, sensor);
  const Calibration truth = skin.truth();
  // The tare step has not masked them.
  SkinCalibration before = blank_calibration(skin.skin());
  before.planes.tare = truth.tare;
  const EquilibrationResult result = skin.equilibrated(before, {0.4});
  EXPECT_EQ(result.calibration.planes.mask, truth.mask);
  EXPECT_EQ(result.findings.size(),
            static_cast<std::size_t>(std::ranges::count(truth.mask, std::uint8_t{0})));
  for (const SenselFinding& finding : result.findings) {
    EXPECT_EQ(finding.fault, SenselFault::unresponsive);
    EXPECT_TRUE(finding.masked);
  }
}

TEST(Equilibration, TheThresholdFollowsTheGains) {
  PressedSkin skin(30, 30, spread_sensor());
  const SkinCalibration before = skin.tared();
  const SkinCalibration after = skin.equilibrated(before, {0.4}).calibration;
  std::size_t above = 0;
  for (std::size_t i = 0; i < after.planes.noise.size(); ++i) {
    if (4 * after.planes.noise[i] * after.planes.gain[i] > *after.threshold_counts) ++above;
  }
  EXPECT_EQ(above, after.planes.noise.size() / 100);
  EXPECT_GT(*after.threshold_counts, *before.threshold_counts);
}

/// The loads, counts, that the experiments press with.
const std::vector<double> kLoads = {12, 30, 60, 100, 160};

/// Equilibrates under uniform pressures of `loads`, counts of the skin.
EquilibrationResult equilibrate_at_loads(PressedSkin& skin, const EquilibrationOptions& options,
                                         const std::vector<double>& loads = kLoads) {
  std::vector<double> forces_n;
  for (const double load : loads) forces_n.push_back(load / skin.skin().counts_per_newton);
  const SkinCalibration before = skin.tared();
  return skin.equilibrated(before, forces_n, options);
}

/// Noise of half a count, gains of 5 %, a dead zone of 5 counts and a power law of 0.9.
PressedSkin curved_skin(double dead_zone, double exponent) {
  SensorModel sensor = spread_sensor();
  sensor.gain_spread = 0.05;
  sensor.noise_counts = 0.5;
  sensor.dead_zone_counts = dead_zone;
  PressedSkin skin(20, 20, sensor);
  if (exponent != 1) skin.scene().skin.power_law = {exponent, 100};
  return skin;
}

/// RMS of the force that the calibration finds at 64 loads of 8 to 190 counts, minus the load, in
/// counts of the skin.
double curve_error(PressedSkin& skin, const EquilibrationResult& result) {
  const Calibration truth = skin.truth();
  const Calibration& found = result.calibration.planes;
  const double k = skin.skin().counts_per_newton;
  const double zone = truth.dead_zone.empty() ? 0 : truth.dead_zone[0];
  double squares = 0;
  for (int step = 0; step < 64; ++step) {
    const double load = 8 + (190.0 - 8) * step / 63;
    const auto& law = skin.skin().power_law;
    double reading = std::max(0.0, load - zone);
    if (law) reading = straightened({1 / law->exponent, law->reference_counts}, reading);
    if (const auto& curve = truth.effects.curve; !curve.empty()) {
      reading = reading_at(curve, reading);
    }
    const double share = 1 / mean_of(truth.gain);
    const double solved = load_at(found.effects.curve, reading * share) +
                          (found.dead_zone.empty() ? 0 : mean_of(found.dead_zone));
    const double error = k * solved / *result.calibration.counts_per_newton - load;
    squares += error * error / 64;
  }
  return std::sqrt(squares);
}

TEST(Equilibration, FindsAResponseCurveAndADeadZone) {
  PressedSkin skin = curved_skin(5, 0.9);
  const EquilibrationResult result = equilibrate_at_loads(skin, {});
  EXPECT_EQ(result.model, ResponseModel::curve);
  EXPECT_NEAR(result.dead_zone_counts * 320 / *result.calibration.counts_per_newton, 5, 0.1);
  EXPECT_LT(*result.held_out_curve, 0.005);
  EXPECT_GT(*result.held_out_linear, 0.01);
  EXPECT_LT(curve_error(skin, result), 0.1);
  PressedSkin same = curved_skin(5, 0.9);
  EXPECT_GT(curve_error(skin, equilibrate_at_loads(same, {.model = ResponseModel::linear})), 0.5);
  const Calibration truth = skin.truth();
  EXPECT_LT(
      relative_errors(result.calibration.planes.gain, truth.gain, 1 / mean_of(truth.gain)).largest,
      0.01);
  ASSERT_TRUE(result.calibration.planes.effects.residual);
  EXPECT_LT(result.calibration.planes.effects.residual->relative, 0.01);
  EXPECT_LT(result.calibration.planes.effects.residual->offset_counts, 0.5);
}

/// The response V/(1 + V/600), from V = 1 to 300 counts.
ResponseCurve saturating_curve() {
  ResponseCurve curve;
  double load = 1;
  while (load < 300) {
    curve.loads.push_back(load);
    curve.readings.push_back(load / (1 + load / 600));
    load *= 1.2;
  }
  return curve;
}

TEST(Equilibration, FindsNoDeadZoneInAResponseThatSaturates) {
  for (const auto& [dead_zone, accuracy] : {std::pair(0.0, 0.1), std::pair(5.0, 0.6)}) {
    PressedSkin skin = curved_skin(dead_zone, 1);
    skin.scene().sensor.effects.curve = saturating_curve();
    const EquilibrationResult result = equilibrate_at_loads(skin, {}, {14, 28, 56, 100, 160, 240});
    EXPECT_EQ(result.model, ResponseModel::curve);
    EXPECT_NEAR(result.dead_zone_counts * 320 / *result.calibration.counts_per_newton, dead_zone,
                accuracy);
    EXPECT_LT(curve_error(skin, result), 0.15);
  }
}

TEST(Equilibration, KeepsStraightLinesWhereACurveDoesNotWin) {
  for (const double dead_zone : {0.0, 5.0}) {
    PressedSkin skin = curved_skin(dead_zone, 1);
    const EquilibrationResult result = equilibrate_at_loads(skin, {});
    EXPECT_EQ(result.model, ResponseModel::linear);
    EXPECT_TRUE(result.calibration.planes.effects.curve.empty());
    EXPECT_LT(curve_error(skin, result), 0.1);
    PressedSkin same = curved_skin(dead_zone, 1);
    EXPECT_LT(curve_error(skin, equilibrate_at_loads(same, {.model = ResponseModel::curve})), 0.1);
  }
}

TEST(Equilibration, TheResidualErrorIsThatOfHeldOutPressures) {
  // The residual of gains from two pressures at a third is that of the noise of all three.
  PressedSkin skin = curved_skin(5, 1);
  const EquilibrationResult result = equilibrate_at_loads(skin, {});
  const auto& residual = result.calibration.planes.effects.residual;
  ASSERT_TRUE(residual);
  const double noise = std::sqrt(0.25 + 1 / 12.0) / 10;
  const double at_middle = std::hypot(residual->offset_counts, 60 * residual->relative);
  EXPECT_GT(at_middle, noise);
  EXPECT_LT(at_middle, 3 * noise);
  PressedSkin few = curved_skin(5, 1);
  EXPECT_FALSE(equilibrate_at_loads(few, {}, {60, 160}).calibration.planes.effects.residual);
}

TEST(Equilibration, KnownLeaksCount) {
  PressedSkin skin = curved_skin(0, 1);
  SkinCalibration before = skin.tared();
  before.planes.effects.sensel_leak = {0.05, 0.02};
  const EquilibrationResult leaking = skin.equilibrated(before, {0.3});
  before.planes.effects.sensel_leak.reset();
  const EquilibrationResult plain = skin.equilibrated(before, {0.3});
  EXPECT_NEAR(*plain.calibration.counts_per_newton / *leaking.calibration.counts_per_newton, 1.14,
              0.005);
  // The corner lacks two neighbours of 0.02.
  const auto ratio = [&](std::size_t i) {
    return leaking.calibration.planes.gain[i] / plain.calibration.planes.gain[i];
  };
  EXPECT_NEAR(ratio(0) / ratio(50 * 20 + 5), 1.10 / 1.14, 5e-3);
}

/// A ball on the skin: far from uniform.
FrameStatistics ball_press(PressedSkin& skin, double radius_mm, double load_n) {
  Scene scene = skin.scene();
  ClosedFormContact ball;
  ball.contact_radius_mm = radius_mm;
  ball.reference_load_n = load_n;
  ball.path = {{0, 0, 0, load_n}};
  scene.load = std::vector<ClosedFormContact>{ball};
  return skin.statistics_of(Simulator(scene), 20);
}

TEST(Equilibration, RefusesAPressureThatIsNotUniform) {
  PressedSkin skin(20, 20, spread_sensor());
  const SkinCalibration before = skin.tared();
  const auto message = [&](const FrameStatistics& press) {
    const UniformPress presses[] = {{press, 100}};
    return message_of([&] { (void)equilibrate(before, presses, {}); });
  };
  EXPECT_NE(message(ball_press(skin, 5, 20)).find("do not respond"), std::string::npos);
  EXPECT_NE(message(ball_press(skin, 19, 300)).find("between pillars"), std::string::npos);
  EXPECT_NE(message(skin.bare(20)).find("do not respond"), std::string::npos);
  EXPECT_NE(message(skin.press(100, 20)).find("full scale"), std::string::npos);
}

TEST(Equilibration, MeasuresUnevenness) {
  SensorModel sensor = spread_sensor();
  PressedSkin skin(20, 20, sensor);
  const SkinCalibration before = skin.tared();
  // The pressure falls off from the middle to the corners by a tenth.
  const FrameStatistics press = ball_press(skin, 40, 1500);
  const UniformPress presses[] = {{press, 300}};
  const double unevenness = equilibrate(before, presses, {.most_unevenness = 1}).unevenness;
  double sum = 0;
  double squares = 0;
  for (int row = 0; row < 20; ++row) {
    for (int col = 0; col < 20; ++col) {
      const double pitch = skin.skin().pillar_pitch_mm();
      const double r = std::hypot((row - 9.5) * pitch, (col - 9.5) * pitch);
      const double log_pressure = 0.5 * std::log(1 - r * r / 1600);
      sum += log_pressure / 400;
      squares += log_pressure * log_pressure / 400;
    }
  }
  EXPECT_NEAR(unevenness, std::sqrt(squares - sum * sum), 0.015);
}

TEST(Equilibration, MeasuresShear) {
  PressedSkin skin(20, 20, spread_sensor());
  const SkinCalibration before = skin.tared();
  Scene scene = skin.scene();
  ClosedFormContact slider;
  slider.motion = ContactMotion::slide;
  slider.friction = 0.1;
  slider.direction_deg = 70;
  slider.contact_radius_mm = 60;
  slider.reference_load_n = 3000;
  slider.path = {{0, 0, 0, 3000}};
  scene.load = std::vector<ClosedFormContact>{slider};
  const FrameStatistics sheared = skin.statistics_of(Simulator(scene), 20);
  const UniformPress presses[] = {{sheared, 300}};
  // The sensels' own spread of 10 % leaves 0.1 √2 / 40 on each axis.
  EXPECT_NEAR(equilibrate(before, presses, {}).shear, 0.1, 4 * 0.0035);
  const FrameStatistics straight = skin.press(0.4, 20);
  const UniformPress upright[] = {{straight, 300}};
  EXPECT_LT(equilibrate(before, upright, {}).shear, 4 * 0.0035);
}

TEST(Equilibration, RefusesWhatIsNotEnough) {
  PressedSkin skin(10, 10, spread_sensor());
  const SkinCalibration before = skin.tared();
  const FrameStatistics press = skin.press(0.4, kFrames);
  const FrameStatistics few = skin.press(0.4, kLeastPressFrames - 1);
  const auto message = [&](const SkinCalibration& calibration, const UniformPress& one) {
    return message_of([&] { (void)equilibrate(calibration, {&one, 1}, {}); });
  };
  EXPECT_EQ(message(before, {few, 100}), "frames.h5: has 4 frames; give at least 5");
  EXPECT_EQ(message(before, {press, 0}), "frames.h5: its pressure is 0 kPa; it must be above zero");
  EXPECT_EQ(message(blank_calibration(skin.skin()), {press, 100}),
            "calibration: has no tare; take the tare of the unloaded skin first");
  Skin other = skin.skin();
  other.rows = 6;
  SkinCalibration of_another = blank_calibration(other);
  of_another.planes.tare.assign(other.sensels(), 0);
  EXPECT_NE(message(of_another, {press, 100}).find("the calibration 6 x 20"), std::string::npos);
  EXPECT_NE(message_of([&] { (void)equilibrate(before, {}, {}); }).find("no press"),
            std::string::npos);
  PressedSkin curved = curved_skin(5, 0.9);
  EXPECT_NE(message_of([&] {
              (void)equilibrate_at_loads(curved, {.model = ResponseModel::curve}, {60});
            }).find("no response curve"),
            std::string::npos);
}

}  // namespace
}  // namespace pillarfield
