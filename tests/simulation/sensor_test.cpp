#include "simulation/sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace pillarfield {
namespace {

constexpr std::uint32_t kSize = 300;

Scene scene_with(const SensorModel& model) {
  Scene scene;
  scene.skin.rows = kSize;
  scene.skin.cols = kSize;
  scene.sensor = model;
  if (model.adc_bits) scene.skin.full_scale_counts = std::ldexp(1.0, *model.adc_bits) - 1;
  return scene;
}

/// Frame that the sensor makes of the same V at every sensel.
FrameBuffer reading_of(double v, const Scene& scene, std::uint64_t frame = 0) {
  const Sensor sensor(scene);
  FrameBuffer raw(sensor.sensel_type(), scene.skin.rows, scene.skin.cols);
  for (std::uint32_t row = 0; row < scene.skin.rows; ++row) {
    std::vector<double> signal(scene.skin.cols, v);
    sensor.read_row(frame, row, signal, raw);
  }
  return raw;
}

struct Moments {
  double mean;
  double deviation;
};

template <class Values>
Moments moments_of(const Values& values) {
  double sum = 0;
  double squares = 0;
  for (const auto value : values) {
    sum += static_cast<double>(value);
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  const double mean = sum / static_cast<double>(values.size());
  return {mean, std::sqrt(squares / static_cast<double>(values.size()) - mean * mean)};
}

TEST(Sensor, WithNothingListedReadingsAreTheModels) {
  const Scene scene = scene_with({});
  EXPECT_TRUE(Sensor(scene).calibration().empty());
  EXPECT_EQ(Sensor(scene).sensel_type(), SenselType::f32);
  const FrameBuffer raw = reading_of(123.456, scene);
  for (const float value : raw.readings<float>()) EXPECT_EQ(value, 123.456F);
}

TEST(Sensor, NoiseHasItsDeviationAndIsNewInEveryFrame) {
  SensorModel model;
  model.noise_counts = 0.7;
  const Scene scene = scene_with(model);
  const FrameBuffer first = reading_of(50, scene, 0);
  const FrameBuffer second = reading_of(50, scene, 1);
  const Moments noise = moments_of(first.readings<float>());
  EXPECT_NEAR(noise.mean, 50, 5 * 0.7 / kSize);
  EXPECT_NEAR(noise.deviation, 0.7, 5 * 0.7 / kSize);
  EXPECT_FALSE(std::ranges::equal(first.readings<float>(), second.readings<float>()));
  EXPECT_TRUE(Sensor(scene).calibration().empty());
}

TEST(Sensor, RecordingsHaveOneSensorAndIndependentNoise) {
  SensorModel model;
  model.noise_counts = 1;
  model.gain_spread = 0.1;
  model.tare_counts = 4;
  model.tare_spread_counts = 1;
  Scene scene = scene_with(model);
  const Sensor first(scene);
  const FrameBuffer at_first = reading_of(0, scene);
  scene.recording = 1;
  EXPECT_EQ(Sensor(scene).calibration().gain, first.calibration().gain);
  EXPECT_EQ(Sensor(scene).calibration().tare, first.calibration().tare);
  const FrameBuffer at_second = reading_of(0, scene);
  double product = 0;
  for (std::size_t i = 0; i < scene.skin.sensels(); ++i) {
    const float tare = first.calibration().tare[i];
    product += double{at_first.readings<float>()[i] - tare} *
               double{at_second.readings<float>()[i] - tare};
  }
  EXPECT_NEAR(product / (kSize * kSize), 0, 5.0 / kSize);
}

TEST(Sensor, SensitivitiesHaveMeanOneAndTheirSpread) {
  SensorModel model;
  model.gain_spread = 0.2;
  const Scene scene = scene_with(model);
  const FrameBuffer raw = reading_of(100, scene);
  const Moments sensitivity = moments_of(raw.readings<float>());
  EXPECT_NEAR(sensitivity.mean, 100, 100 * 5 * 0.2 / kSize);
  EXPECT_NEAR(sensitivity.deviation, 20, 100 * 8 * 0.2 / kSize);
  const Sensor sensor(scene);
  const std::vector<float>& gain = sensor.calibration().gain;
  for (std::size_t i = 0; i < gain.size(); ++i) {
    EXPECT_GT(gain[i], 0);
    EXPECT_NEAR(raw.readings<float>()[i] * gain[i], 100, 1e-4);
  }
}

TEST(Sensor, TaresHaveTheirMeanAndSpreadAndAreNotNegative) {
  SensorModel model;
  model.tare_counts = 12;
  model.tare_spread_counts = 1.5;
  const Moments tare = moments_of(reading_of(0, scene_with(model)).readings<float>());
  EXPECT_NEAR(tare.mean, 12, 5 * 1.5 / kSize);
  EXPECT_NEAR(tare.deviation, 1.5, 5 * 1.5 / kSize);
  model.tare_counts = 0;
  const Sensor sensor(scene_with(model));
  EXPECT_GE(std::ranges::min(sensor.calibration().tare), 0);
}

TEST(Sensor, DeadSenselsHaveTheirShareAndReadZero) {
  SensorModel model;
  model.dead_share = 0.03;
  model.noise_counts = 1;
  model.tare_counts = 5;
  const Scene scene = scene_with(model);
  const Sensor sensor(scene);
  const std::vector<std::uint8_t>& mask = sensor.calibration().mask;
  const FrameBuffer raw = reading_of(80, scene);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    EXPECT_EQ(mask[i] == 0, raw.readings<float>()[i] == 0);
  }
  const auto dead = static_cast<double>(std::ranges::count(mask, 0));
  EXPECT_NEAR(dead / (kSize * kSize), 0.03, 5 * std::sqrt(0.03) / kSize);
  model.dead_share = 1;
  EXPECT_EQ(std::ranges::max(reading_of(80, scene_with(model)).readings<float>()), 0);
}

/// The first sensel's reading of V, whatever its type.
double first_reading(double v, const Scene& scene) {
  const FrameBuffer raw = reading_of(v, scene);
  switch (raw.view().type) {
    case SenselType::u8:
      return raw.readings<std::uint8_t>()[0];
    case SenselType::u16:
      return raw.readings<std::uint16_t>()[0];
    case SenselType::f32:
      break;
  }
  return raw.readings<float>()[0];
}

TEST(Sensor, ReadsOneForceThroughDeadZonePowerLawAndConverter) {
  const PowerLaw law = {1.25, 64};
  const struct {
    double dead_zone_counts = 0;
    std::optional<PowerLaw> power_law;
    std::optional<int> adc_bits;
    double v = 0;
    double expected = 0;
  } cases[] = {
      {2.5, {}, {}, 10, 7.5},    {2.5, {}, {}, 2.5, 0},
      {2.5, {}, {}, 1, 0},       {2, law, {}, 66, 64},
      {2, law, {}, 1, 0},        {2, law, {}, 18, 64 * std::pow(16.0 / 64, 1 / 1.25)},
      {0, {}, 8, 0.49, 0},       {0, {}, 8, 0.51, 1},
      {0, {}, 8, 99.5, 100},     {0, {}, 8, 254.6, 255},
      {0, {}, 8, 1e9, 255},      {0, {}, 12, 1e9, 4095},
      {0, {}, 12, 1234.4, 1234}, {0, {}, 1, 7, 1},
  };
  for (const auto& each : cases) {
    SensorModel model;
    model.dead_zone_counts = each.dead_zone_counts;
    model.adc_bits = each.adc_bits;
    Scene scene = scene_with(model);
    scene.skin.power_law = each.power_law;
    EXPECT_NEAR(first_reading(each.v, scene), each.expected, 1e-5) << each.v;
  }
}

TEST(Sensor, WithoutAConverterOnlyAFullScaleClips) {
  SensorModel model;
  model.noise_counts = 1;
  Scene scene = scene_with(model);
  EXPECT_LT(std::ranges::min(reading_of(0, scene).readings<float>()), 0);
  scene.skin.full_scale_counts = 10;
  EXPECT_EQ(std::ranges::max(reading_of(50, scene).readings<float>()), 10);
}

}  // namespace
}  // namespace pillarfield
