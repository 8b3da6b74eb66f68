#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "pillarfield/error.h"
#include "pillarfield/recording.h"
#include "tests/io/full_files.h"

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

using Names = std::vector<std::string>;

Skin skin_of(std::uint32_t rows, std::uint32_t cols) {
  Skin skin;
  skin.rows = rows;
  skin.cols = cols;
  return skin;
}

/// A calibration with a random set of planes and values anywhere in their ranges.
Calibration random_calibration(const Skin& skin, SenselType type, std::mt19937& random) {
  const auto coin = [&] { return std::bernoulli_distribution(0.5)(random); };
  const auto plane = [&](float low, float high) {
    std::vector<float> values(coin() ? skin.sensels() : 0);
    for (float& value : values) value = std::uniform_real_distribution<float>(low, high)(random);
    return values;
  };
  Calibration calibration;
  const auto largest = static_cast<float>(largest_plane_counts(type));
  calibration.tare = plane(-largest, largest);
  calibration.gain = plane(0.01f, 100.0f);
  calibration.dead_zone = plane(0.0f, largest);
  calibration.noise = plane(0.0f, std::min(largest, 1e6f));
  if (coin()) {
    for (auto* bend : {&calibration.bend_x, &calibration.bend_y, &calibration.bend_xy}) {
      bend->assign(skin.sensels(), std::uniform_real_distribution<float>(-1e9f, 1e9f)(random));
    }
  }
  if (coin()) calibration.effects.sensel_leak = {0.2, -0.01};
  if (coin()) calibration.effects.curve = {{0.5, 30, 1e9}, {0.25, 31, 1e9}};
  calibration.mask.resize(coin() ? skin.sensels() : 0);
  for (auto& good : calibration.mask) good = coin() ? kGood : coin() ? kAbsent : kMissing;
  return calibration;
}

/// A surface of each shape in turn; unset for every fifth.
std::optional<Surface> surface_number(int number, const Skin& skin) {
  if (number % 5 == 4) return std::nullopt;
  Surface surface;
  surface.shape = static_cast<SurfaceShape>(number % 5);
  if (surface.shape == SurfaceShape::cylinder || surface.shape == SurfaceShape::sphere) {
    surface.radius_mm = -77.5;
    surface.axis_deg = 12.25;
  }
  if (surface.shape == SurfaceShape::height_map) surface.heights_mm.assign(skin.pillars(), -1.5F);
  return surface;
}

void expect_equal(const Skin& read, const Skin& written) {
  ASSERT_EQ(read.surface.has_value(), written.surface.has_value());
  if (read.surface) {
    EXPECT_EQ(read.surface->shape, written.surface->shape);
    EXPECT_EQ(read.surface->radius_mm, written.surface->radius_mm);
    EXPECT_EQ(read.surface->axis_deg, written.surface->axis_deg);
    EXPECT_EQ(read.surface->heights_mm, written.surface->heights_mm);
  }
  EXPECT_EQ(read.rows, written.rows);
  EXPECT_EQ(read.cols, written.cols);
  EXPECT_EQ(read.sensel_pitch_mm, written.sensel_pitch_mm);
  EXPECT_EQ(read.counts_per_newton, written.counts_per_newton);
  EXPECT_EQ(read.threshold_counts, written.threshold_counts);
  EXPECT_EQ(read.full_scale_counts, written.full_scale_counts);
  ASSERT_EQ(read.power_law.has_value(), written.power_law.has_value());
  if (!read.power_law) return;
  EXPECT_EQ(read.power_law->exponent, written.power_law->exponent);
  EXPECT_EQ(read.power_law->reference_counts, written.power_law->reference_counts);
}

void expect_equal(const Calibration& read, const Calibration& written) {
  EXPECT_EQ(planes_of(read), planes_of(written));
  EXPECT_EQ(read.effects.curve.readings, written.effects.curve.readings);
  EXPECT_EQ(read.effects.curve.loads, written.effects.curve.loads);
  ASSERT_EQ(read.effects.sensel_leak.has_value(), written.effects.sensel_leak.has_value());
  if (read.effects.sensel_leak) {
    EXPECT_EQ(read.effects.sensel_leak->inside, 0.2);
    EXPECT_EQ(read.effects.sensel_leak->across, -0.01);
  }
}

/// Checks that a recording returns its content bit for bit.
void expect_round_trip(const Skin& skin, SenselType type, const Calibration& calibration,
                       bool truth, std::uint64_t frames) {
  const TemporaryDirectory directory;
  const auto path = directory / "recording.h5";
  FrameBuffer frame(type, skin.rows, skin.cols);
  RecordingWriter writer(path, skin, type, calibration, {.truth = truth, .flush_every = 3});
  for (std::uint64_t index = 0; index < frames; ++index) {
    fill_frame(index, frame);
    const ForceField forces = sample_forces(index, skin.pillar_rows(), skin.pillar_cols());
    writer.append(frame.view(), static_cast<double>(index) / 7, truth ? &forces : nullptr);
  }
  writer.finish();
  EXPECT_EQ(directory.names(), Names{"recording.h5"});

  const auto source = open_frames(path);
  EXPECT_EQ(source->format(), "recording");
  EXPECT_EQ(source->sensel_type(), type);
  EXPECT_EQ(source->has_truth(), truth);
  ASSERT_EQ(source->frames(), frames);
  expect_equal(source->skin(), skin);
  expect_equal(source->calibration(), calibration);
  FrameBuffer read(type, skin.rows, skin.cols);
  for (std::uint64_t index = frames; index-- > 0;) {
    fill_frame(index, frame);
    EXPECT_EQ(source->read(index, read), static_cast<double>(index) / 7);
    EXPECT_TRUE(std::ranges::equal(read.bytes(), frame.bytes())) << "frame " << index;
    if (!truth) continue;
    ForceField forces;
    source->read_truth(index, forces);
    const ForceField expected = sample_forces(index, skin.pillar_rows(), skin.pillar_cols());
    EXPECT_EQ(forces.shear_x, expected.shear_x);
    EXPECT_EQ(forces.shear_y, expected.shear_y);
    EXPECT_EQ(forces.normal, expected.normal);
  }
}

/// A frame of which two blocks did not arrive, after a whole one.
void expect_incomplete_frames(SenselType type) {
  const TemporaryDirectory directory;
  Skin skin;
  skin.rows = 20;
  skin.cols = 12;
  Calibration calibration;
  calibration.tare.assign(skin.sensels(), 0);
  calibration.noise.assign(skin.sensels(), 0);
  const auto path = directory / "recording.h5";
  RecordingWriter writer(path, skin, type, calibration, {.missing = true});
  FrameBuffer frame(type, skin.rows, skin.cols);
  fill_frame(1, frame);
  writer.append(frame.view(), 0);
  const std::array<SenselBlock, 2> lost = {{{0, 3, 4, 8}, {19, 1, 0, 12}}};
  writer.append_incomplete(frame.view(), 1, lost);
  const std::array<SenselBlock, 1> beyond = {{{18, 3, 0, 1}}};
  EXPECT_THROW(writer.append_incomplete(frame.view(), 2, beyond), Error);
  calibration.tare.assign(skin.sensels(), 3);
  calibration.noise.assign(skin.sensels(), 0.5F);
  writer.set_tare(calibration, 2.5);
  Calibration wrong;
  wrong.tare = {1};
  EXPECT_THROW(writer.set_tare(wrong, 2.5), Error);
  writer.finish();

  const auto source = open_frames(path);
  ASSERT_EQ(source->frames(), 2);
  EXPECT_EQ(source->calibration().tare, calibration.tare);
  EXPECT_EQ(source->calibration().noise, calibration.noise);
  EXPECT_EQ(source->skin().threshold_counts, 2.5);
  FrameBuffer read(type, skin.rows, skin.cols);
  source->read(0, read);
  EXPECT_TRUE(std::ranges::equal(read.bytes(), frame.bytes()));
  source->read(1, read);
  const auto warns = std::ranges::count_if(source->warnings(), [](const std::string& warning) {
    return warning.starts_with("1 of 2 frames arrived incomplete");
  });
  if (type != SenselType::f32) {
    EXPECT_EQ(warns, 1);
    EXPECT_TRUE(std::ranges::equal(read.bytes(), frame.bytes()));
    return;
  }
  EXPECT_EQ(warns, 0);
  const auto* const before = static_cast<const float*>(frame.view().data);
  const auto* const after = static_cast<const float*>(read.view().data);
  for (std::uint32_t i = 0; i < skin.sensels(); ++i) {
    const std::uint32_t row = i / skin.cols;
    const bool is_lost = (row < 3 && i % skin.cols >= 4) || row == 19;
    EXPECT_TRUE(is_lost ? std::isnan(after[i]) : after[i] == before[i]) << i;
  }
}

TEST(RecordingRoundTrip, StatesFramesThatArrivedIncompleteAndATareThatCameLater) {
  expect_incomplete_frames(SenselType::u8);
  expect_incomplete_frames(SenselType::f32);
  const TemporaryDirectory directory;
  Skin skin;
  skin.rows = skin.cols = 4;
  RecordingWriter writer(directory / "r.h5", skin, SenselType::u8, {}, {});
  Calibration tare;
  tare.tare.assign(16, 1);
  EXPECT_THROW(writer.set_tare(tare, 0), Error);
}

TEST(RecordingRoundTrip, KeepsEverythingOfAnySizeAndType) {
  std::mt19937 random(1);
  const auto pick = [&](std::uint32_t low, std::uint32_t high) {
    return std::uniform_int_distribution<std::uint32_t>(low, high)(random);
  };
  for (const auto type : {SenselType::u8, SenselType::u16, SenselType::f32}) {
    for (int trial = 0; trial < 8; ++trial) {
      Skin skin = skin_of(trial == 0 ? 2 : pick(2, 45), trial == 0 ? 2 : pick(2, 45));
      skin.sensel_pitch_mm = 1.0 / pick(1, 9);
      skin.counts_per_newton = pick(1, 1000) / 7.0;
      skin.threshold_counts = pick(0, 20) / 3.0;
      if (trial % 2 == 0) skin.full_scale_counts = 200 + pick(0, 10) / 3.0;
      if (trial % 3 == 0) skin.power_law = {1 + pick(0, 10) / 7.0, 50 + pick(0, 10) / 3.0};
      skin.surface = surface_number(trial, skin);
      SCOPED_TRACE(testing::Message() << skin.rows << " x " << skin.cols << " " << name_of(type));
      expect_round_trip(skin, type, random_calibration(skin, type, random), trial % 3 == 0,
                        trial == 1 ? 0 : pick(1, 20));
    }
  }
}

TEST(RecordingRoundTrip, KeepsFramesThatFillManyChunks) {
  expect_round_trip(skin_of(2, 2), SenselType::u8, {}, true, 2500);
}

TEST(RecordingRoundTrip, KeepsAFrameLargerThanAnyCache) {
  expect_round_trip(skin_of(1581, 1581), SenselType::f32, {}, false, 2);
}

TEST(RecordingRoundTrip, TakesRowsOfALargerFrame) {
  const TemporaryDirectory directory;
  FrameBuffer whole(SenselType::u16, 9, 13);
  fill_frame(0, whole);
  const auto readings = whole.readings<std::uint16_t>();
  // The last row of this view ends with the last reading of the buffer.
  const FrameView view = {&readings[5 * 13 + 9], SenselType::u16, 4, 4, 13};
  RecordingWriter writer(directory / "r.h5", skin_of(4, 4), SenselType::u16, {}, {});
  writer.append(view, 0);
  writer.finish();
  FrameBuffer read(SenselType::u16, 4, 4);
  open_frames(directory / "r.h5")->read(0, read);
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t col = 0; col < 4; ++col) {
      EXPECT_EQ(read.readings<std::uint16_t>()[row * 4 + col], readings[(5 + row) * 13 + 9 + col]);
    }
  }
}

TEST(RecordingWriter, RefusesUnfitFramesAndContinues) {
  const TemporaryDirectory directory;
  RecordingWriter writer(directory / "r.h5", skin_of(4, 4), SenselType::u8, {}, {.truth = true});
  const FrameBuffer frame(SenselType::u8, 4, 4);
  const ForceField truth(2, 2);
  const ForceField small_truth(1, 2);
  const auto refused = [&](const FrameView& view, double time_s, const ForceField* forces) {
    return error_of([&] { writer.append(view, time_s, forces); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(has_all(refused(FrameBuffer(SenselType::u8, 4, 5).view(), 0, &truth), {"4 x 5"}));
  EXPECT_TRUE(has_all(refused(FrameBuffer(SenselType::u16, 4, 4).view(), 0, &truth), {"uint16"}));
  EXPECT_TRUE(has_all(refused({}, 0, &truth), {"0 x 0"}));
  EXPECT_TRUE(has_all(refused(frame.view(), nan, &truth), {"frame 0", "nan"}));
  EXPECT_TRUE(has_all(refused(frame.view(), 0, nullptr), {"has no truth"}));
  EXPECT_TRUE(has_all(refused(frame.view(), 0, &small_truth), {"1 x 2"}));
  writer.append(frame.view(), 0, &truth);
  writer.finish();
  EXPECT_TRUE(has_all(refused(frame.view(), 1, &truth), {"is finished"}));
  EXPECT_EQ(open_frames(directory / "r.h5")->frames(), 1u);
}

TEST(RecordingWriter, RefusesValuesOutOfRange) {
  const TemporaryDirectory directory;
  const auto refused = [&](const Skin& skin, const Calibration& calibration,
                           const RecordingWriter::Options& options) {
    return error_of(
        [&] { RecordingWriter(directory / "r.h5", skin, SenselType::u8, calibration, options); });
  };
  Calibration calibration;
  calibration.gain = {1, 1, 0, 1};
  EXPECT_TRUE(has_all(refused(skin_of(1, 2), {}, {}), {"r.h5", "rows is 1"}));
  EXPECT_TRUE(has_all(refused(skin_of(2, 2), calibration, {}), {"gain", "row 1, column 0"}));
  EXPECT_TRUE(has_all(refused(skin_of(2, 4), calibration, {}), {"'gain' has 4 values", "2 x 4"}));
  EXPECT_TRUE(has_all(refused(skin_of(2, 2), {}, {.flush_every = 0}), {"flush_every"}));
  EXPECT_EQ(directory.names(), Names{});
}

TEST(Recording, RefusesAbsentFramesAndUnfitBuffers) {
  const TemporaryDirectory directory;
  RecordingWriter writer(directory / "r.h5", skin_of(2, 2), SenselType::u8, {}, {});
  writer.append(FrameBuffer(SenselType::u8, 2, 2).view(), 0);
  writer.finish();
  const auto source = open_frames(directory / "r.h5");
  FrameBuffer fitting(SenselType::u8, 2, 2);
  FrameBuffer wide(SenselType::u16, 2, 2);
  ForceField truth;
  EXPECT_TRUE(has_all(error_of([&] { source->read(1, fitting); }), {"no frame 1", "1 frame,"}));
  EXPECT_TRUE(has_all(error_of([&] { source->read(0, wide); }), {"uint16", "uint8"}));
  EXPECT_TRUE(has_all(error_of([&] { source->read_truth(0, truth); }), {"no true forces"}));
}

}  // namespace
}  // namespace pillarfield
