// Live tare and the watch over sensels.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <thread>

#include "pillarfield/error.h"
#include "pillarfield/live_tare.h"
#include "pillarfield/sensel_watch.h"
#include "pillarfield/simulator.h"
#include "pillarfield/tare.h"
#include "tests/base/message.h"
#include "tests/calibration/pressed_skin.h"

namespace pillarfield {
namespace {

using core_test::message_of;
using core_test::PressedSkin;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

SensorModel live_sensor() {
  SensorModel sensor;
  sensor.tare_counts = 12;
  sensor.tare_spread_counts = 1.5;
  sensor.noise_counts = 1;
  sensor.adc_bits = 8;
  return sensor;
}

Scene swaying_ball() {
  Scene scene;
  scene.skin.rows = scene.skin.cols = 40;
  scene.sensor = live_sensor();
  ClosedFormContact ball;
  ball.contact_radius_mm = 26;
  ball.reference_load_n = 300;
  ball.path = {{0, -2, -2, 20}, {0.5, 2, 0, 300}, {1, 0, 2, 40}, {1.5, 1, -2, 280}, {2, 0, 0, 5}};
  scene.load = std::vector<ClosedFormContact>{ball};
  return scene;
}

/// Frames of a scene, one after the other.
class Frames {
 public:
  explicit Frames(const Scene& scene)
      : simulator_(scene),
        frame_(simulator_.sensel_type(), scene.skin.rows, scene.skin.cols),
        truth_(scene.skin.pillar_rows(), scene.skin.pillar_cols()) {}

  FrameBuffer& next() {
    simulator_.render(index_++ % 200, frame_, truth_);
    return frame_;
  }
  [[nodiscard]] const Simulator& simulator() const { return simulator_; }

 private:
  Simulator simulator_;
  FrameBuffer frame_;
  ForceField truth_;
  std::uint64_t index_ = 0;
};

SolverPlan plan_of(const Skin& skin) {
  SolverPlan plan;
  plan.skin = skin;
  plan.calibration.tare.assign(skin.sensels(), 0);
  return plan;
}

/// The plan with the tare of frames at 1 kHz over 20 ms, where `spoil` changes each.
SolverPlan tared(LiveTare& tare, Frames& frames, bool preloaded = false,
                 const std::function<void(FrameBuffer&)>& spoil = {}) {
  tare.start(milliseconds(20), preloaded);
  for (nanoseconds now(0);; now += milliseconds(1)) {
    FrameBuffer& frame = frames.next();
    if (spoil) spoil(frame);
    if (const SolverPlan* const found = tare.add(frame.view(), now)) return *found;
  }
}

/// A tare at 1 kHz over 200 ms: 50 of the frames, so that its error is that of 50 readings.
TEST(LiveTare, IsTheMeanOfFramesOverItsDuration) {
  PressedSkin skin(20, 20, live_sensor());
  Frames frames(skin.scene());
  const Calibration truth = skin.truth();
  LiveTare tare(plan_of(skin.skin()));
  EXPECT_EQ(tare.add(frames.next().view(), nanoseconds(0)), nullptr) << "before start()";
  tare.start(milliseconds(200));
  const SolverPlan* found = nullptr;
  int count = 0;
  for (nanoseconds now(5'000'000'000); found == nullptr; now += milliseconds(1), ++count) {
    found = tare.add(frames.next().view(), now);
    EXPECT_EQ(tare.is_running(), found == nullptr);
  }
  EXPECT_EQ(count, 201);
  for (std::size_t i = 0; i < truth.tare.size(); ++i) {
    EXPECT_LT(std::abs(found->calibration.tare[i] - truth.tare[i]),
              5.2 * std::sqrt((1 + 1 / 12.0) / 50))
        << i;
  }
}

/// However short the duration, enough frames are averaged.
TEST(LiveTare, WaitsForEnoughFrames) {
  PressedSkin skin(10, 10, live_sensor());
  Frames frames(skin.scene());
  LiveTare tare(plan_of(skin.skin()));
  tare.start(milliseconds(1));
  std::uint32_t count = 1;
  for (nanoseconds now(0); tare.add(frames.next().view(), now) == nullptr;
       now += milliseconds(10)) {
    ++count;
  }
  EXPECT_EQ(count, kLeastTareFrames);
}

TEST(LiveTare, RefusesATouchedSkinUnlessPreloaded) {
  Scene scene = swaying_ball();
  std::get<std::vector<ClosedFormContact>>(scene.load).front().contact_radius_mm = 5;
  LiveTare tare(plan_of(scene.skin));
  Frames frames(scene);
  EXPECT_NE(message_of([&] { tared(tare, frames); }).find("touched"), std::string::npos);
  EXPECT_FALSE(tare.is_running());
  tared(tare, frames, true);
  EXPECT_FALSE(tare.is_running());
}

/// As `calibrate tare` has it; a threshold that the user stated stays.
TEST(LiveTare, TakesNoiseAndThresholdToo) {
  PressedSkin skin(20, 20, live_sensor());
  for (const bool keeps : {false, true}) {
    Frames frames(skin.scene());
    SolverPlan plan = plan_of(skin.skin());
    plan.skin.threshold_counts = 50;
    LiveTare tare(plan, keeps);
    const SolverPlan found = tared(tare, frames);
    ASSERT_EQ(found.calibration.noise.size(), plan.skin.sensels());
    EXPECT_NEAR(found.calibration.noise[7], 1.04, 0.7);
    EXPECT_NEAR(found.skin.threshold_counts, keeps ? 50 : 6, keeps ? 0 : 1.5);
    EXPECT_NE(tare.note().find("would not have been seen"), std::string::npos) << tare.note();
  }
}

TEST(LiveTare, ComparesWithTheTareBefore) {
  Scene scene = swaying_ball();
  scene.load = std::vector<ClosedFormContact>{};
  Frames frames(scene);
  LiveTare tare(plan_of(scene.skin));
  tared(tare, frames);
  const auto touch = [](FrameBuffer& frame) {
    std::uint8_t& reading = frame.readings<std::uint8_t>()[405];
    reading = static_cast<std::uint8_t>(reading + 40);
  };
  const std::string message = message_of([&] { tared(tare, frames, false, touch); });
  EXPECT_NE(message.find("1 sensel changed since the tare before"), std::string::npos) << message;
}

/// Offers frames until the watch finds `wanted`, for at most a minute.
SenselHealth watched(SenselWatch& watch, Frames& frames,
                     const std::function<void(FrameBuffer&)>& spoil,
                     const std::function<bool(const SenselHealth&)>& wanted) {
  for (int i = 0; i < 6000 && !wanted(watch.health()); ++i) {
    FrameBuffer& frame = frames.next();
    spoil(frame);
    watch.offer(frame.view());
    std::this_thread::sleep_for(milliseconds(10));
  }
  return watch.health();
}

SolverPlan watched_plan(const Frames& frames) {
  SolverPlan plan;
  plan.skin = frames.simulator().scene().skin;
  plan.skin.threshold_counts = 4.5;
  plan.calibration = frames.simulator().calibration();
  plan.calibration.noise.assign(plan.skin.sensels(), 1.04F);
  return plan;
}

TEST(SenselWatch, CountsDeadAndStuckSenselsUntilTheyMove) {
  Frames frames(swaying_ball());
  SenselWatch watch(watched_plan(frames), milliseconds(100));
  const auto spoil = [](FrameBuffer& frame) {
    frame.readings<std::uint8_t>()[40 * 11 + 13] = 0;
    frame.readings<std::uint8_t>()[40 * 21 + 20] = 90;
    frame.readings<std::uint8_t>()[40 * 20 + 31] = 90;
  };
  const SenselHealth faulty =
      watched(watch, frames, spoil, [](const auto& found) { return found.dead + found.stuck > 0; });
  EXPECT_EQ(faulty.dead, 1);
  EXPECT_EQ(faulty.stuck, 2);
  const SenselHealth healed = watched(
      watch, frames, [](FrameBuffer&) {},
      [](const auto& found) { return found.dead + found.stuck == 0; });
  EXPECT_EQ(healed.dead + healed.stuck, 0);
}

TEST(SenselWatch, CountsSenselsThatLeaveTheirTareUntilItIsTakenAnew) {
  PressedSkin skin(20, 20, live_sensor());
  Frames frames(skin.scene());
  const SolverPlan plan = watched_plan(frames);
  SenselWatch watch(plan, milliseconds(100));
  const auto spoil = [](FrameBuffer& frame) {
    for (const std::size_t i : {5U, 77U, 500U}) frame.readings<std::uint8_t>()[i] += 3;
    frame.readings<std::uint8_t>()[900] += 40;  // In contact.
  };
  EXPECT_EQ(
      watched(watch, frames, spoil, [](const auto& found) { return found.drifting > 0; }).drifting,
      3);
  SolverPlan retared = plan;
  for (const std::size_t i : {5U, 77U, 500U}) retared.calibration.tare[i] += 3;
  watch.set_plan(retared);
  EXPECT_EQ(
      watched(watch, frames, spoil, [](const auto& found) { return found.drifting == 0; }).drifting,
      0);
}

}  // namespace
}  // namespace pillarfield
