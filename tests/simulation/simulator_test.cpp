#include "pillarfield/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

/// A noisy skin with a ball that moves.
Scene noisy_scene(std::uint64_t seed) {
  Scene scene;
  scene.skin.rows = 64;
  scene.skin.cols = 52;
  scene.sensor.noise_counts = 0.5;
  scene.sensor.gain_spread = 0.1;
  scene.sensor.tare_counts = 3;
  scene.sensor.tare_spread_counts = 1;
  scene.sensor.dead_share = 0.01;
  scene.sensor.adc_bits = 8;
  scene.frames = 10;
  scene.seed = seed;
  ClosedFormContact ball;
  ball.motion = ContactMotion::slide;
  ball.contact_radius_mm = 8;
  ball.reference_load_n = 20;
  ball.friction = 1.3;
  ball.path = {{0, -5, 0, 20}, {0.1, 5, 3, 30}};
  scene.load = std::vector{ball};
  return scene;
}

struct Rendered {
  explicit Rendered(const Simulator& simulator)
      : raw(simulator.sensel_type(), simulator.scene().skin.rows, simulator.scene().skin.cols),
        truth(simulator.scene().skin.pillar_rows(), simulator.scene().skin.pillar_cols()) {}
  FrameBuffer raw;
  ForceField truth;

  bool operator==(const Rendered& other) const {
    return std::ranges::equal(raw.bytes(), other.raw.bytes()) &&
           truth.shear_x == other.truth.shear_x && truth.shear_y == other.truth.shear_y &&
           truth.normal == other.truth.normal && truth.status == other.truth.status;
  }
};

Rendered render(const Simulator& simulator, std::uint64_t index) {
  Rendered frame(simulator);
  simulator.render(index, frame.raw, frame.truth);
  return frame;
}

TEST(Simulator, AnotherSeedMakesAnotherSensorAndOtherNoiseOfTheSameTruth) {
  const Simulator one(noisy_scene(4));
  const Simulator two(noisy_scene(5));
  EXPECT_NE(one.calibration().gain, two.calibration().gain);
  EXPECT_NE(one.calibration().tare, two.calibration().tare);
  EXPECT_NE(one.calibration().mask, two.calibration().mask);
  EXPECT_FALSE(render(one, 0) == render(two, 0));
  EXPECT_EQ(render(one, 3).truth.normal, render(two, 3).truth.normal);
}

TEST(Simulator, OrderAndOldContentsDoNotMatter) {
  const Simulator simulator(noisy_scene(4));
  Rendered reused(simulator);
  std::fill(reused.raw.bytes().begin(), reused.raw.bytes().end(), std::byte{0xAB});
  std::fill(reused.truth.normal.begin(), reused.truth.normal.end(), 9.0F);
  std::fill(reused.truth.status.begin(), reused.truth.status.end(), std::uint8_t{255});
  for (const std::uint64_t index : {9U, 2U, 5U, 0U, 2U}) {
    simulator.render(index, reused.raw, reused.truth);
    EXPECT_EQ(reused, render(simulator, index)) << index;
  }
}

/// Readings and truth of frames rendered together.
std::vector<Rendered> render_all(const Simulator& simulator, std::uint64_t first,
                                 std::uint64_t count, unsigned threads) {
  std::vector<Rendered> frames;
  const auto take = [&](std::uint64_t index, const FrameView& raw, const ForceField& truth) {
    EXPECT_EQ(index, first + frames.size());
    frames.emplace_back(simulator);
    std::memcpy(frames.back().raw.bytes().data(), raw.data, frames.back().raw.bytes().size());
    frames.back().truth = truth;
  };
  simulator.render_all(first, count, take, threads);
  EXPECT_EQ(frames.size(), count);
  return frames;
}

/// A frame depends on its index alone: neither on threads nor on where a run starts.
void expect_same_frames(const Scene& scene, std::uint64_t frames) {
  const Simulator alone(scene);
  std::vector<Rendered> expected;
  for (std::uint64_t i = 0; i < frames; ++i) expected.push_back(render(alone, i));
  for (const unsigned threads : {0U, 1U, 2U, 7U}) {
    const Simulator simulator(scene);
    for (const auto& [first, count] :
         {std::pair{std::uint64_t{0}, frames}, {3, frames - 4}, {0, 3}, {frames - 1, 1}, {1, 0}}) {
      const std::vector<Rendered> made = render_all(simulator, first, count, threads);
      for (std::size_t i = 0; i < made.size(); ++i) {
        EXPECT_EQ(made[i], expected[first + i]) << threads << " threads, frame " << first + i;
      }
    }
  }
}

TEST(Simulator, ThreadsAndSplitsMakeTheSameFrames) {
  expect_same_frames(noisy_scene(4), 23);
  Scene with_memory = noisy_scene(4);
  with_memory.sensor.hysteresis = 0.1;
  with_memory.sensor.creep_per_decade = 0.05;
  with_memory.sensor.effects.sensel_leak = {0.03, 0};
  expect_same_frames(with_memory, 11);
  Scene pressed = noisy_scene(4);
  pressed.load = std::vector<ClosedFormContact>();
  Indenter ball;
  ball.path = {{0, -1, 0, 0, 2}, {0.05, 1, 0, 10, 3}};
  pressed.indenters = {ball, ball};
  pressed.indenters.back().path = {{0, 5, 5, 0, 2}, {0.05, 4, 5, 0, 1}};
  expect_same_frames(pressed, 6);
}

TEST(Simulator, WhatTakingAFrameThrowsEndsTheRendering) {
  const Simulator simulator(noisy_scene(4));
  std::uint64_t taken = 0;
  const auto take = [&](std::uint64_t, const FrameView&, const ForceField&) {
    if (++taken == 5) throw Error("sink", "is full", "empty it");
  };
  for (const unsigned threads : {1U, 2U, 7U}) {
    taken = 0;
    EXPECT_THROW(simulator.render_all(0, 1'000'000'000, take, threads), Error);
    EXPECT_EQ(taken, 5);
  }
}

TEST(Simulator, FramesFollowTheClockAndThePath) {
  const Simulator simulator(noisy_scene(4));
  EXPECT_DOUBLE_EQ(simulator.time_of(0), 0);
  EXPECT_DOUBLE_EQ(simulator.time_of(5), 0.05);
  const auto load_at = [&](std::uint64_t index) {
    double sum = 0;
    for (const float normal : render(simulator, index).truth.normal) sum += double{normal};
    return sum;
  };
  EXPECT_NEAR(load_at(0), 20, 2e-5);
  EXPECT_NEAR(load_at(5), 25, 2e-5);
  EXPECT_NEAR(load_at(500), 30, 3e-5);
}

TEST(Simulator, ContactsAddUp) {
  Scene scene = noisy_scene(1);
  const ClosedFormContact ball = std::get<std::vector<ClosedFormContact>>(scene.load).front();
  ClosedFormContact punch = ball;
  punch.shape = ContactShape::flat_punch;
  punch.path = {{0, 3, 3, 7}};
  const auto normal_of = [&](std::vector<ClosedFormContact> load) {
    scene.load = std::move(load);
    return render(Simulator(scene), 0).truth.normal;
  };
  const std::vector<float> both = normal_of({ball, punch});
  const std::vector<float> first = normal_of({ball});
  const std::vector<float> second = normal_of({punch});
  for (std::size_t i = 0; i < both.size(); ++i) EXPECT_NEAR(both[i], first[i] + second[i], 1e-6F);
}

Scene sweep_scene() {
  Scene scene;
  DirectionSweep sweep;
  sweep.magnitudes_n = {0.3, 1e-3};
  scene.load = sweep;
  scene.skin.rows = 2 * 31 * 2;
  scene.skin.cols = 2 * 72;
  return scene;
}

TEST(Simulator, ADirectionSweepHoldsEveryDirectionFromWhichAForceComes) {
  const Rendered frame = render(Simulator(sweep_scene()), 7);
  using std::numbers::pi;
  for (std::size_t row = 0; row < 62; ++row) {
    for (std::size_t col = 0; col < 72; ++col) {
      const double magnitude = row < 31 ? 0.3 : 1e-3;
      const double theta = static_cast<double>(row % 31) * pi / 60;
      const double phi = static_cast<double>(col) * pi / 36;
      const std::size_t i = row * 72 + col;
      EXPECT_NEAR(frame.truth.shear_x[i], -magnitude * std::sin(theta) * std::cos(phi), 3e-8);
      EXPECT_NEAR(frame.truth.shear_y[i], -magnitude * std::sin(theta) * std::sin(phi), 3e-8);
      EXPECT_NEAR(frame.truth.normal[i], magnitude * std::cos(theta), 3e-8);
    }
  }
}

TEST(Simulator, ADirectionSweepFollowsItsFactor) {
  Scene scene = sweep_scene();
  const Rendered whole = render(Simulator(scene), 0);
  std::get<DirectionSweep>(scene.load).path = {{0.1, 0}, {0.3, 2}, {0.5, 2}, {0.6, 0.5}};
  const Simulator simulator(scene);
  const std::pair<std::uint64_t, float> factors[] = {{5, 0}, {15, 0.5}, {40, 2}, {99, 0.5}};
  for (const auto& [frame, factor] : factors) {
    const Rendered scaled = render(simulator, frame);
    for (std::size_t i = 0; i < scaled.truth.normal.size(); ++i) {
      EXPECT_NEAR(scaled.truth.normal[i], factor * whole.truth.normal[i], 1e-7F);
      EXPECT_EQ(scaled.truth.status[i] != 0, factor != 0);
    }
  }
}

/// Equation (2) of the paper, sensel by sensel, at the place in the frame that the design gives it.
TEST(Simulator, ReadingsAreThePapersEquationAtTheirSensel) {
  const Simulator simulator(sweep_scene());
  const Rendered frame = render(simulator, 0);
  const auto raw = frame.raw.readings<float>();
  using std::numbers::pi;
  for (std::size_t row = 0; row < 31; ++row) {
    for (std::size_t col = 0; col < 72; ++col) {
      const double theta = static_cast<double>(row) * pi / 60;
      const double phi = static_cast<double>(col) * pi / 36;
      const std::size_t upper = 2 * row * 144 + 2 * col;
      const std::size_t sensels[] = {upper + 1, upper, upper + 144, upper + 145};
      for (int n = 1; n <= 4; ++n) {
        const double v =
            0.3 * 320 * (std::cos(theta) - std::sin(theta) * std::cos(pi / 4 * (2 * n - 1) - phi));
        EXPECT_NEAR(raw[sensels[n - 1]], std::max(0.0, v), 1e-4) << row << " " << col;
        const bool positive = (frame.truth.status[row * 72 + col] >> (n - 1) & 1) != 0;
        EXPECT_EQ(positive, raw[sensels[n - 1]] > 0);
      }
    }
  }
}

TEST(Simulator, TheStatusHoldsUsableBitsOnlyAndIgnoresTheSensor) {
  Scene scene = noisy_scene(4);
  const Rendered noisy = render(Simulator(scene), 0);
  scene.sensor = {};
  const Rendered clean = render(Simulator(scene), 0);
  EXPECT_EQ(noisy.truth.status, clean.truth.status);
  EXPECT_GT(std::ranges::count(clean.truth.status, status::kUsable), 0);
  for (const std::uint8_t status : clean.truth.status) EXPECT_EQ(status & ~status::kUsable, 0);
}

TEST(Simulator, AnOddRowOrColumnIsReadWithoutLoad) {
  Scene scene = noisy_scene(1);
  scene.sensor = {};
  scene.sensor.tare_counts = 2;
  scene.skin.rows = 33;
  scene.skin.cols = 27;
  std::get<std::vector<ClosedFormContact>>(scene.load).front().contact_radius_mm = 30;
  const Rendered frame = render(Simulator(scene), 0);
  const auto raw = frame.raw.readings<float>();
  EXPECT_GT(raw[0], 2);
  for (std::size_t row = 0; row < 33; ++row) EXPECT_EQ(raw[row * 27 + 26], 2);
  for (std::size_t col = 0; col < 27; ++col) EXPECT_EQ(raw[std::size_t{32} * 27 + col], 2);
}

TEST(Simulator, AConverterSetsTheFullScale) {
  Scene scene = noisy_scene(1);
  scene.sensor.adc_bits = 10;
  EXPECT_EQ(Simulator(scene).scene().skin.full_scale_counts, 1023);
  scene.skin.full_scale_counts = 900;
  EXPECT_EQ(Simulator(scene).scene().skin.full_scale_counts, 900);
}

TEST(Simulator, RefusesBuffersThatDoNotFit) {
  const Simulator simulator(noisy_scene(1));
  Rendered fits(simulator);
  FrameBuffer floats(SenselType::f32, 64, 52);
  FrameBuffer small(SenselType::u8, 64, 50);
  ForceField narrow(32, 25);
  EXPECT_THROW(simulator.render(0, floats, fits.truth), Error);
  EXPECT_THROW(simulator.render(0, small, fits.truth), Error);
  EXPECT_THROW(simulator.render(0, fits.raw, narrow), Error);
}

}  // namespace
}  // namespace pillarfield
