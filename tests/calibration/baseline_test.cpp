// The baseline follows drift where nothing touches the skin, and only there.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "pillarfield/processor.h"
#include "pillarfield/simulator.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

/// A ball of 4 mm contact radius pressed on a patch of 15 x 15 pillars, or nothing.
Scene pressed_scene(double load_n) {
  Scene scene;
  scene.skin.rows = 30;
  scene.skin.cols = 30;
  scene.skin.threshold_counts = 4;
  scene.sensor.tare_counts = 40;
  scene.sensor.tare_spread_counts = 3;
  scene.sensor.noise_counts = 1;
  scene.frames = 10'000;
  if (load_n == 0) {
    scene.load = std::vector<ClosedFormContact>();
    return scene;
  }
  ClosedFormContact ball;
  ball.contact_radius_mm = 4;
  ball.reference_load_n = load_n;
  ball.path = {{0, 0, 0, load_n}};
  scene.load = std::vector<ClosedFormContact>{ball};
  return scene;
}

/// A drift of all sensels: a level and a slope over the columns, counts.
struct Drift {
  double level = 0;
  double per_col = 0;
};

/// Frames of a scene, solved one after the other with a baseline that follows.
class Follower {
 public:
  Follower(const Scene& scene, double time_constant_s, std::optional<int> interval = {})
      : simulator_(scene),
        raw_(simulator_.sensel_type(), scene.skin.rows, scene.skin.cols),
        truth_(scene.skin.pillar_rows(), scene.skin.pillar_cols()),
        unloaded_(simulator_.calibration().tare) {
    SolverPlan plan;
    plan.skin = scene.skin;
    plan.sensel_type = simulator_.sensel_type();
    plan.calibration = simulator_.calibration();
    plan.frame_interval_s = 1 / scene.rate_hz;
    set_baseline(plan, time_constant_s);
    if (interval) plan.baseline_interval = *interval;
    processor_.emplace(open_device("host"), plan);
  }

  /// Solves the next frame, to whose readings `drift` is added, counts.
  ForceField step(const Drift& drift = {}) {
    simulator_.render(frame_++, raw_, truth_);
    const std::span<float> readings = raw_.readings<float>();
    for (std::size_t i = 0; i < readings.size(); ++i) {
      readings[i] +=
          static_cast<float>(drift.level + drift.per_col * (static_cast<double>(i % 30) - 14.5));
    }
    processor_->submit(raw_.view());
    return ForceField(processor_->receive());
  }

  [[nodiscard]] std::vector<float> tare() const { return processor_->tare(); }
  [[nodiscard]] const std::vector<float>& unloaded() const { return unloaded_; }
  [[nodiscard]] const ForceField& truth() const { return truth_; }

 private:
  Simulator simulator_;
  FrameBuffer raw_;
  ForceField truth_;
  std::vector<float> unloaded_;
  std::optional<Processor> processor_;
  std::uint64_t frame_ = 0;
};

TEST(Baseline, IsFrozenAtTheFringeOfAContact) {
  // So light that the outermost pillars flicker about the threshold.
  Follower follower(pressed_scene(2), 1);
  for (int i = 0; i < 1'000; ++i) follower.step();
  const ForceField& truth = follower.truth();
  int frozen = 0;
  int flickering = 0;
  for (std::size_t row = 0; row < truth.rows; ++row) {
    for (std::size_t col = 0; col < truth.cols; ++col) {
      if (truth.normal[row * truth.cols + col] == 0) continue;
      ++frozen;
      flickering += truth.normal[row * truth.cols + col] < 4 / 320.0 ? 1 : 0;
      for (const std::size_t at : {2 * row * 30 + 2 * col, (2 * row + 1) * 30 + 2 * col + 1}) {
        EXPECT_NEAR(follower.tare()[at], follower.unloaded()[at], 0.1);
      }
    }
  }
  EXPECT_GT(frozen, 20);
  EXPECT_GT(flickering, 3);
}

/// Root mean square over the sensels of the tare's distance from the drifted baseline.
double tracking_error(const Follower& follower, const Scene& scene, int frames) {
  // The drift is linear: two noiseless frames show it.
  Scene quiet = scene;
  quiet.sensor.noise_counts = 0;
  const Simulator simulator(quiet);
  FrameBuffer raw(simulator.sensel_type(), scene.skin.rows, scene.skin.cols);
  ForceField truth(scene.skin.pillar_rows(), scene.skin.pillar_cols());
  simulator.render(static_cast<std::uint64_t>(frames), raw, truth);
  const std::vector<float> tare = follower.tare();
  double squares = 0;
  for (std::size_t i = 0; i < tare.size(); ++i) {
    const double error = tare[i] - raw.readings<float>()[i];
    squares += error * error;
  }
  return std::sqrt(squares / static_cast<double>(tare.size()));
}

TEST(Baseline, FollowsTheDriftOfAnUntouchedSkin) {
  Scene scene = pressed_scene(0);
  scene.sensor.drift_counts_per_s = 0.3;
  constexpr int kFrames = 10'000;
  Follower follower(scene, 2);
  const double adrift = tracking_error(follower, scene, kFrames);
  EXPECT_NEAR(adrift, 30, 2) << "0.3 counts per second for 100 seconds";
  for (int i = 0; i < kFrames; ++i) follower.step();
  // It lags by 0.3 counts/s times 2 s, and has sqrt(rate / 2) = 0.05 of the noise.
  EXPECT_LT(tracking_error(follower, scene, kFrames), 0.8);
}

/// RMS error of the forces of pressed pillars, N, and the number of those that are not, while a
/// ball lies for ten seconds on a skin that drifts.
struct UnderADrift {
  double error = 0;
  int false_pillars = 0;
};
UnderADrift under_a_drift(const Drift& per_s, int interval = 1) {
  Scene scene = pressed_scene(20);
  scene.skin.threshold_counts = 6;
  std::get<std::vector<ClosedFormContact>>(scene.load).front().path = {
      {0, 0, 0, 0}, {0.5, 0, 0, 0}, {1, 0, 0, 20}, {11, 0, 0, 20}};
  Follower follower(scene, 1, interval);
  UnderADrift result;
  double squares = 0;
  double pressed = 0;
  for (int frame = 0; frame < 1'100; ++frame) {
    const double t = 0.01 * frame;
    const ForceField solved = follower.step({per_s.level * t, per_s.per_col * t});
    for (std::size_t i = 0; frame > 900 && i < solved.elements(); ++i) {
      const double truth = follower.truth().normal[i];
      result.false_pillars += truth == 0 && (solved.status[i] & status::kUsable) != 0 ? 1 : 0;
      if (truth < 0.1) continue;
      for (const auto plane : {&ForceField::shear_x, &ForceField::shear_y, &ForceField::normal}) {
        const double error = (solved.*plane)[i] - (follower.truth().*plane)[i];
        squares += error * error;
      }
      ++pressed;
    }
  }
  result.error = std::sqrt(squares / pressed);
  return result;
}

TEST(Baseline, WhatUntouchedSenselsDriftInCommonIsTakenOffTouchedOnes) {
  const UnderADrift without = under_a_drift({});
  const double three_counts = 3.0 / 11;
  for (const Drift& each :
       {Drift{three_counts, 0}, Drift{-three_counts, 0}, Drift{three_counts, three_counts / 15}}) {
    for (const int interval : {1, 5}) {
      const UnderADrift with = under_a_drift(each, interval);
      EXPECT_LT(with.error, 1.2 * without.error) << each.level << ", " << each.per_col;
      EXPECT_LE(with.false_pillars, without.false_pillars);
    }
  }
}

double rms_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += std::pow(double{a[i]} - b[i], 2);
  return std::sqrt(squares / static_cast<double>(a.size()));
}

/// A skin at 500 Hz that is followed with 2 s, so that a row has its turn in each seventh frame.
Scene scene_in_turns(double load_n) {
  Scene scene = pressed_scene(load_n);
  scene.rate_hz = 500;
  scene.skin.threshold_counts = 6;
  return scene;
}

constexpr double kTimeInTurnsS = 2;
constexpr double kMostInTurns = 0.1;  // A turn has sqrt(7 / 2000) = 0.06 of a reading's noise.

TEST(Baseline, InTurnsIsThatOfEveryFrameBesideTheNoise) {
  const Scene scene = scene_in_turns(20);
  Follower every(scene, kTimeInTurnsS, 1);
  Follower turns(scene, kTimeInTurnsS);
  double error = 0;
  double difference = 0;
  for (int frame = 0; frame < 3'000; ++frame) {
    const Drift drift = {0.3 * frame / scene.rate_hz};
    const ForceField expected = every.step(drift);
    const ForceField solved = turns.step(drift);
    for (std::size_t i = 0; frame >= 1'500 && i < solved.elements(); ++i) {
      error += std::pow(expected.normal[i] - every.truth().normal[i], 2);
      difference += std::pow(solved.normal[i] - expected.normal[i], 2);
    }
  }
  EXPECT_NE(turns.tare(), every.tare());
  EXPECT_LT(rms_difference(turns.tare(), every.tare()), kMostInTurns);
  EXPECT_LT(difference, 0.01 * error);
}

/// Each tenth frame would see a hum of 50 Hz at one phase.
TEST(Baseline, InTurnsIsNotDeceivedByHum) {
  const Scene scene = scene_in_turns(0);
  constexpr double kHumCounts = 1.5;
  Follower turns(scene, kTimeInTurnsS);
  Follower tenth(scene, kTimeInTurnsS, 10);
  for (int frame = 0; frame < 3'000; ++frame) {
    const double turn = 50 * frame / scene.rate_hz;
    const Drift hum = {kHumCounts * std::cos(2 * std::numbers::pi * turn)};
    turns.step(hum);
    tenth.step(hum);
  }
  EXPECT_LT(rms_difference(turns.tare(), turns.unloaded()), kMostInTurns);
  EXPECT_GT(rms_difference(tenth.tare(), tenth.unloaded()), 0.5 * kHumCounts);
}

}  // namespace
}  // namespace pillarfield
