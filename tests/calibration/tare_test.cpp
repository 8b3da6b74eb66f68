// The tare: what it finds, with its error, and what it refuses.

#include "pillarfield/tare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pillarfield/error.h"
#include "tests/base/message.h"
#include "tests/calibration/pressed_skin.h"

namespace pillarfield {
namespace {

using core_test::message_of;
using core_test::PressedSkin;

constexpr std::uint32_t kTareFrames = 100;

/// 900 pillars of 12 counts of tare and one of noise, 8 bits.
SensorModel common_sensor() {
  SensorModel sensor;
  sensor.tare_counts = 12;
  sensor.tare_spread_counts = 1.5;
  sensor.noise_counts = 1;
  sensor.adc_bits = 8;
  return sensor;
}

PressedSkin common_skin() { return {30, 30, common_sensor()}; }

TareResult tare_of(const TareFrames& unloaded, const TareOptions& options = {}) {
  return take_tare(blank_calibration(unloaded.skin()), unloaded, options);
}

/// The noise of a rounded reading.
const double kReadingNoise = std::sqrt(1 + 1 / 12.0);

TEST(Tare, IsTheMeanWithinItsStandardError) {
  PressedSkin skin = common_skin();
  const Calibration truth = skin.truth();
  const TareResult result = tare_of(skin.bare(kTareFrames));
  const std::vector<float>& tare = result.calibration.planes.tare;
  double squares = 0;
  for (std::size_t i = 0; i < tare.size(); ++i) {
    const double error = tare[i] - truth.tare[i];
    EXPECT_LT(std::abs(error), 5 * kReadingNoise / std::sqrt(kTareFrames)) << i;
    squares += error * error;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(tare.size())),
              kReadingNoise / std::sqrt(kTareFrames), 0.01);
  EXPECT_TRUE(result.findings.empty());
  EXPECT_TRUE(result.calibration.planes.mask.empty());
}

TEST(Tare, NoiseIsTheStandardDeviationAndMakesTheThreshold) {
  PressedSkin skin = common_skin();
  const TareResult result = tare_of(skin.bare(kTareFrames), {.threshold_factor = 3});
  const std::vector<float>& noise = result.calibration.planes.noise;
  // The standard error of a standard deviation of n readings is a share 1/sqrt(2 (n - 1)) of it.
  const double error = kReadingNoise / std::sqrt(2.0 * (kTareFrames - 1));
  for (const float value : noise) EXPECT_NEAR(value, kReadingNoise, 5.5 * error);
  EXPECT_NEAR(result.noise_counts, kReadingNoise, error / 10);
  const double threshold = result.calibration.threshold_counts.value();
  EXPECT_NEAR(threshold, 3 * (kReadingNoise + 2.33 * error), 3 * 0.3 * error);
  const auto above = std::ranges::count_if(noise, [&](float n) { return 3 * n > threshold; });
  EXPECT_LE(above, static_cast<long>(noise.size() / 100));
  EXPECT_GT(above, 0);
}

TEST(Tare, WholeCountsHaveAtLeastTheirRoundingError) {
  SensorModel sensor = common_sensor();
  sensor.noise_counts = 0;
  PressedSkin skin(4, 4, sensor);
  for (const float value : tare_of(skin.bare(kTareFrames)).calibration.planes.noise) {
    EXPECT_FLOAT_EQ(value, static_cast<float>(1 / std::sqrt(12.0)));
  }
  sensor.adc_bits.reset();
  PressedSkin exact(4, 4, sensor);
  const TareResult result = tare_of(exact.bare(kTareFrames));
  for (const float value : result.calibration.planes.noise) EXPECT_EQ(value, 0);
  EXPECT_EQ(result.calibration.threshold_counts, 0);
}

/// Statistics of frames that a function fills, sensel by sensel, frame by frame.
template <class Reading>
TareFrames frames_of(std::uint32_t rows, std::uint32_t cols, std::uint32_t frames, Reading reading,
                     std::optional<double> full_scale = {}) {
  Skin skin;
  skin.rows = rows;
  skin.cols = cols;
  skin.full_scale_counts = full_scale;
  TareFrames statistics("frames.h5", skin, SenselType::f32);
  FrameBuffer frame(SenselType::f32, rows, cols);
  for (std::uint32_t t = 0; t < frames; ++t) {
    for (std::size_t i = 0; i < skin.sensels(); ++i) {
      frame.readings<float>()[i] = static_cast<float>(reading(i, t));
    }
    statistics.add(frame.view());
  }
  return statistics;
}

/// A tare of 10 counts, and one count up and down.
double flicker(std::size_t sensel, std::uint32_t frame) {
  return (sensel + frame) % 2 == 0 ? 9 : 11;
}

/// 10 x 10 sensels of which some are peculiar.
double peculiar(std::size_t sensel, std::uint32_t frame) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const double usual = flicker(sensel, frame);
  switch (sensel) {
    case 3:  // mostly no number
      return frame % 3 == 0 ? usual : kNan;
    case 10:  // at full scale
      return 250;
    case 20:  // stuck high
      return 100;
    case 30:  // stuck low
      return -7;
    case 40:  // comes and goes
      return frame % 2 == 0 ? 0 : 40;
    case 50:  // constant where it may be
      return 10;
    case 60:  // a high tare, and alive
      return 30 + usual;
    case 70:  // one reading lost
      return frame == 5 ? kNan : usual;
    default:
      return usual;
  }
}

const SenselFinding* finding_of(const TareResult& result, std::size_t sensel) {
  const auto found = std::ranges::find_if(result.findings, [=](const SenselFinding& finding) {
    return finding.row * 10 + finding.col == sensel;
  });
  return found == result.findings.end() ? nullptr : &*found;
}

TEST(Tare, MasksWhatCannotBeRightAndSaysWhy) {
  const TareResult result = tare_of(frames_of(10, 10, 60, peculiar, 250));
  ASSERT_EQ(result.findings.size(), 5U);
  const std::vector<std::pair<std::size_t, SenselFault>> expected = {{3, SenselFault::not_a_number},
                                                                     {10, SenselFault::saturated},
                                                                     {20, SenselFault::stuck},
                                                                     {30, SenselFault::stuck},
                                                                     {40, SenselFault::noisy}};
  for (const auto& [sensel, fault] : expected) {
    const SenselFinding* const finding = finding_of(result, sensel);
    ASSERT_NE(finding, nullptr) << sensel;
    EXPECT_EQ(finding->fault, fault) << sensel;
    EXPECT_TRUE(finding->masked);
    EXPECT_EQ(result.calibration.planes.mask[sensel], 0);
  }
  EXPECT_EQ(std::ranges::count(result.calibration.planes.mask, 0), 5);
  EXPECT_FLOAT_EQ(result.calibration.planes.tare[60], 40);
  EXPECT_NO_THROW(check(result.calibration, "result"));
}

TEST(Tare, KeepsWhatWasKnownBefore) {
  PressedSkin skin = common_skin();
  SkinCalibration before = blank_calibration(skin.skin());
  before.counts_per_newton = 123;
  before.planes.gain.assign(skin.skin().sensels(), 2);
  before.planes.mask.assign(skin.skin().sensels(), 1);
  before.planes.mask[5] = 0;
  const TareResult result = take_tare(before, skin.bare(kTareFrames), {});
  EXPECT_EQ(result.calibration.counts_per_newton, 123);
  EXPECT_EQ(result.calibration.planes.gain, before.planes.gain);
  EXPECT_EQ(result.calibration.planes.mask, before.planes.mask);
  EXPECT_TRUE(result.findings.empty()) << "a sensel that was masked is no finding";
  // The threshold is compared with corrected readings, which the gain has made twice as noisy.
  EXPECT_NEAR(result.calibration.threshold_counts.value(),
              2 * tare_of(skin.bare(kTareFrames)).calibration.threshold_counts.value(), 0.2);
}

TEST(Tare, RefusesTooFewFramesAndOtherSkins) {
  PressedSkin skin = common_skin();
  const TareFrames few = skin.bare(kLeastTareFrames - 1);
  EXPECT_EQ(message_of([&] { (void)tare_of(few); }), "frames.h5: has 19 frames; give at least 20");
  PressedSkin other(30, 31, common_sensor());
  const SkinCalibration before = blank_calibration(other.skin());
  const std::string message = message_of([&] { (void)take_tare(before, few, {}); });
  EXPECT_NE(message.find("60 x 60"), std::string::npos) << message;
  EXPECT_NE(message.find("60 x 62"), std::string::npos) << message;
}

TEST(Tare, RefusesASensorOfWhichLittleIsRight) {
  const TareFrames broken = frames_of(10, 10, 20, [](std::size_t i, std::uint32_t t) -> double {
    return i % 8 < 5 ? std::nan("") : flicker(i, t);
  });
  EXPECT_NE(message_of([&] { (void)tare_of(broken); }).find("are faulty"), std::string::npos);
  const TareFrames dead = frames_of(10, 10, 20, [](auto...) { return std::nan(""); });
  EXPECT_NE(message_of([&] { (void)tare_of(dead); }).find("no sensel"), std::string::npos);
}

}  // namespace
}  // namespace pillarfield
