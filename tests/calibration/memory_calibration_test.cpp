// Hysteresis and creep from uniform pressure that rises, rests and falls.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "pillarfield/calibration_steps.h"
#include "pillarfield/processor.h"
#include "pillarfield/untouched_skin.h"
#include "tests/base/message.h"
#include "tests/calibration/pressed_skin.h"

namespace pillarfield {
namespace {

using core_test::message_of;
using core_test::PressedSkin;

constexpr double kRateHz = 20;
constexpr double kTopN = 0.5;

/// A skin with noise 0.5 and gains of 5 %, with 20 frames a second.
PressedSkin remembering_skin(double hysteresis, double creep, double dead_zone = 0,
                             double exponent = 1) {
  SensorModel sensor;
  sensor.tare_counts = 12;
  sensor.gain_spread = 0.05;
  sensor.noise_counts = 0.5;
  sensor.hysteresis = hysteresis;
  sensor.hysteresis_range_counts = 320 * kTopN;
  sensor.creep_per_decade = creep;
  sensor.dead_zone_counts = dead_zone;
  PressedSkin skin(10, 10, sensor);
  if (exponent != 1) skin.scene().skin.power_law = {exponent, 100};
  skin.scene().rate_hz = kRateHz;
  return skin;
}

using Path = std::vector<FactorKey>;

/// Triangles of three heights, and a step held for half a minute.
const Path kTriangles = {{0, 0},    {3, 0.4}, {6, 0},  {10, 0.7}, {14, 0.2},
                         {17, 0.7}, {21, 0},  {26, 1}, {31, 0}};
const Path kHold = {{0, 0}, {1, 0}, {1.05, 0.6}, {30, 0.6}, {30.05, 0}, {33, 0}};
/// Another course, which no fit has seen.
const Path kCourse = {{0, 0},   {2, 0.9},  {4, 0.5},  {6, 0.6},
                      {9, 0.1}, {11, 0.8}, {16, 0.8}, {18, 0}};

double factor_at(const Path& path, double time_s) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (time_s > path[i].time_s) continue;
    const double part = (time_s - path[i - 1].time_s) / (path[i].time_s - path[i - 1].time_s);
    return path[i - 1].factor + part * (path[i].factor - path[i - 1].factor);
  }
  return path.back().factor;
}

/// Calls `use(frame, time, factor)` for each frame of the skin under kTopN times the path.
template <class Use>
void play(PressedSkin& skin, const Path& path, Use use) {
  Scene scene = skin.scene();
  scene.load = DirectionSweep{.directions = 10,
                              .inclinations = 10,
                              .max_theta_deg = 0,
                              .magnitudes_n = {kTopN},
                              .path = path};
  const Simulator simulator(scene);
  FrameBuffer frame(simulator.sensel_type(), 20, 20);
  ForceField truth(10, 10);
  const auto frames = static_cast<std::uint64_t>(path.back().time_s * kRateHz);
  for (std::uint64_t i = 0; i < frames; ++i) {
    simulator.render(i, frame, truth);
    const double time_s = static_cast<double>(i) / kRateHz;
    use(frame.view(), time_s, factor_at(path, time_s));
  }
}

SkinCalibration pressed_at_once(PressedSkin& skin, std::optional<ResponseModel> model = {}) {
  const SkinCalibration tared = skin.tared();
  std::vector<FrameStatistics> frames;
  const std::vector<double> forces =
      model ? std::vector<double>{0.06, 0.12, 0.25, 0.45} : std::vector<double>{0.3};
  for (const double force : forces) {
    PressedSkin rested = skin;  // Its frames begin at zero, after a rest.
    frames.push_back(rested.press(force, 40));
  }
  std::vector<UniformPress> presses;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    presses.push_back({frames[i], skin.pressure_kpa(forces[i])});
  }
  return equilibrate(tared, presses, {.model = model}).calibration;
}

MemoryResult remembered(PressedSkin& skin, const SkinCalibration& before) {
  MemoryFinder finder(skin.skin(), before);
  for (const Path& path : {kTriangles, kHold}) {
    finder.begin();
    play(skin, path, [&](const FrameView& frame, double time_s, double factor) {
      finder.add(frame, time_s, skin.pressure_kpa(kTopN * factor));
    });
  }
  return finder.result();
}

/// RMS error of the mean force on kCourse, in counts of 1/320 N.
double course_error(PressedSkin& skin, const SkinCalibration& calibration) {
  SolverPlan plan;
  plan.skin = skin.skin();
  plan.skin.power_law.reset();
  plan.sensel_type = SenselType::f32;
  plan.estimator = Estimator::direct;
  plan.frame_interval_s = 1 / kRateHz;
  apply(calibration, plan.skin, plan.calibration);
  Processor processor(open_device("host"), plan);
  double squares = 0;
  double count = 0;
  play(skin, kCourse, [&](const FrameView& frame, double, double factor) {
    processor.submit(frame);
    const ForceFieldView forces = processor.receive();
    const double total = std::accumulate(forces.normal.begin(), forces.normal.end(), 0.0);
    if (factor < 0.1) return;
    const double error = 320 * (total / 100 - kTopN * factor);
    squares += error * error;
    ++count;
  });
  return std::sqrt(squares / count);
}

TEST(MemoryCalibration, FindsHysteresisOrCreepAlone) {
  for (const bool creeps : {false, true}) {
    PressedSkin skin = remembering_skin(creeps ? 0 : 0.05, creeps ? 0.05 : 0);
    const SkinCalibration before = pressed_at_once(skin);
    const MemoryResult result = remembered(skin, before);
    EXPECT_TRUE(result.found);
    EXPECT_NEAR(result.hysteresis, creeps ? 0 : 0.05, creeps ? 0.01 : 0.005);
    EXPECT_NEAR(result.creep_per_decade, creeps ? 0.05 : 0, creeps ? 0.01 : 0.003);
    EXPECT_GT(result.residual_before, 2 * result.residual_after);
    EXPECT_LT(course_error(skin, result.calibration), 0.5);
    EXPECT_GT(course_error(skin, before), 1);
  }
}

/// Ramps of 16 frames have few frames at small readings, which must not bend the curve there.
TEST(MemoryCalibration, KeepsTheThresholdAboveTheNoise) {
  PressedSkin skin = remembering_skin(0.05, 0);
  const SkinCalibration before = pressed_at_once(skin, ResponseModel::curve);
  MemoryFinder finder(skin.skin(), before);
  const Path ramps = {{0, 0},   {0.8, 1}, {1.6, 0},    {2.1, 0.5}, {2.5, 0.1}, {3.1, 0.75},
                      {3.8, 0}, {4.1, 0}, {4.15, 0.6}, {5.6, 0.6}, {5.65, 0},  {6.7, 0}};
  play(skin, ramps, [&](const FrameView& frame, double time_s, double factor) {
    finder.add(frame, time_s, skin.pressure_kpa(kTopN * factor));
  });
  const MemoryResult result = finder.result();
  EXPECT_TRUE(result.curved);
  EXPECT_LE(untouched_share(result.calibration), kMostUntouched);
  EXPECT_GT(*result.calibration.threshold_counts, 2);
  EXPECT_LT(course_error(skin, result.calibration), 0.8);
}

/// A skin whose readings follow a play that closes at zero, or keeps half of its width there.
MemoryResult remembered_loop(bool closed) {
  Skin skin;
  skin.rows = skin.cols = 4;
  SkinCalibration calibration = blank_calibration(skin);
  calibration.planes.tare.assign(16, 0);
  calibration.threshold_counts = 2;
  calibration.counts_per_newton = 320;
  MemoryFinder finder(skin, calibration);
  FrameBuffer frame(SenselType::f32, 4, 4);
  const double area_mm2 = skin.pillar_pitch_mm() * skin.pillar_pitch_mm();
  double held = 0;
  for (int i = 0; i < 160; ++i) {
    const double load = (i < 40 ? 2.5 : 5) * std::abs((i + 20) % 40 - 20);
    held =
        std::clamp(held, closed ? std::max(0.0, load - 30) : load - 15, closed ? load : load + 15);
    std::ranges::fill(frame.readings<float>(), static_cast<float>(load + 0.2 * held));
    finder.add(frame.view(), 0.05 * i, 1000 * load / 320 / area_mm2);
  }
  return finder.result();
}

TEST(MemoryCalibration, RefusesALoopThatIsOpenAtZero) {
  EXPECT_NE(message_of([] { (void)remembered_loop(false); }).find("the skin keeps a reading of"),
            std::string::npos);
  EXPECT_TRUE(remembered_loop(true).found);
}

TEST(MemoryCalibration, FindsBothAndADeadZoneUnderAResponseCurveToo) {
  for (const double exponent : {1.0, 0.9}) {
    PressedSkin skin = remembering_skin(0.05, 0.05, 5, exponent);
    const bool is_curved = exponent != 1;
    const auto model = is_curved ? std::optional(ResponseModel::curve) : std::nullopt;
    const SkinCalibration before = pressed_at_once(skin, model);
    const MemoryResult result = remembered(skin, before);
    EXPECT_TRUE(result.found);
    EXPECT_EQ(result.curved, is_curved);
    if (!is_curved) {
      EXPECT_NEAR(result.dead_zone_counts * 320 / *result.calibration.counts_per_newton, 5, 1);
    }
    EXPECT_LT(course_error(skin, result.calibration), 0.8);
    EXPECT_GT(course_error(skin, before), 2);
  }
}

TEST(MemoryCalibration, FindsNothingWithoutMemory) {
  for (const double dead_zone : {0.0, 5.0}) {
    PressedSkin skin = remembering_skin(0, 0, dead_zone);
    const SkinCalibration before = pressed_at_once(skin, ResponseModel::linear);
    const MemoryResult result = remembered(skin, before);
    EXPECT_FALSE(result.found);
    EXPECT_FALSE(result.calibration.planes.effects.memory);
    EXPECT_EQ(result.calibration.planes.dead_zone, before.planes.dead_zone);
    EXPECT_LT(result.hysteresis, 0.001);
    EXPECT_LT(result.creep_per_decade, 0.001);
  }
}

TEST(MemoryCalibration, RefusesWhatDoesNotTell) {
  PressedSkin skin = remembering_skin(0, 0);
  const SkinCalibration before = pressed_at_once(skin);
  const auto message = [&](const Path& path) {
    MemoryFinder finder(skin.skin(), before);
    play(skin, path, [&](const FrameView& frame, double time_s, double factor) {
      finder.add(frame, time_s, skin.pressure_kpa(kTopN * factor));
    });
    return message_of([&] { (void)finder.result(); });
  };
  EXPECT_NE(message({{0, 0}, {1, 1}}).find("20 frames are too few"), std::string::npos);
  EXPECT_NE(message({{0, 1}, {5, 1}}).find("does not change"), std::string::npos);
  EXPECT_NE(message_of([&] {
              MemoryFinder(skin.skin(), blank_calibration(skin.skin()));
            }).find("equilibrate first"),
            std::string::npos);
  MemoryFinder finder(skin.skin(), before);
  FrameBuffer frame(SenselType::f32, 20, 20);
  finder.add(frame.view(), 1, 0);
  EXPECT_NE(message_of([&] { finder.add(frame.view(), 1, 0); }).find("times must rise"),
            std::string::npos);
}

}  // namespace
}  // namespace pillarfield
