// Hysteresis and creep from uniform pressure that rises, rests and falls.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pillarfield/calibration_steps.h"
#include "pillarfield/tare.h"
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
  const SkinCalibration tared =
      take_tare(blank_calibration(skin.skin()), skin.bare(100), {}).calibration;
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

/// V from a reading by bisection of the model, and its states.
class Inverse {
 public:
  explicit Inverse(const std::optional<SenselMemory>& memory)
      : memory_(memory.value_or(SenselMemory{})),
        plays_(memory_.plays.size()),
        creep_(memory_.creep.size()) {}

  double load(double reading, double interval_s) {
    double low = -10;
    double high = 1000;
    for (int step = 0; step < 60; ++step) {
      const double middle = (low + high) / 2;
      (read(middle) < reading ? low : high) = middle;
    }
    for (std::size_t i = 0; i < plays_.size(); ++i) plays_[i] = play_at(i, low);
    for (std::size_t i = 0; i < creep_.size(); ++i) {
      creep_[i] -= std::expm1(-interval_s / memory_.creep[i].time_s) * (low - creep_[i]);
    }
    return low;
  }

 private:
  [[nodiscard]] double play_at(std::size_t i, double load) const {
    const double lower = std::max(0.0, load - memory_.plays[i].width_counts);
    return std::clamp(plays_[i], lower, std::max(lower, load));
  }
  [[nodiscard]] double read(double load) const {
    double reading = load;
    for (std::size_t i = 0; i < plays_.size(); ++i) {
      reading += memory_.plays[i].weight * play_at(i, load);
    }
    for (std::size_t i = 0; i < creep_.size(); ++i) reading += memory_.creep[i].weight * creep_[i];
    return reading;
  }

  SenselMemory memory_;
  std::vector<double> plays_;
  std::vector<double> creep_;
};

/// RMS error of the force on kCourse, in counts of 1/320 N: that of the mean reading of all
/// sensels.
double course_error(PressedSkin& skin, const SkinCalibration& calibration) {
  const Calibration& planes = calibration.planes;
  Inverse inverse(planes.effects.memory);
  double squares = 0;
  double count = 0;
  play(skin, kCourse, [&](const FrameView& frame, double, double factor) {
    const auto* raw = static_cast<const float*>(frame.data);
    double reading = 0;
    for (std::size_t i = 0; i < 400; ++i) {
      const double linear = (raw[i] - planes.tare[i]) * planes.gain[i];
      reading += load_at(planes.effects.curve, linear) / 400;
    }
    const double zone = planes.dead_zone.empty() ? 0 : planes.dead_zone[0];
    const double load = inverse.load(reading, 1 / kRateHz);
    if (factor < 0.1) return;
    const double error = 320 * ((load + zone) / *calibration.counts_per_newton - kTopN * factor);
    squares += error * error;
    ++count;
  });
  return std::sqrt(squares / count);
}

TEST(MemoryCalibration, FindsHysteresis) {
  PressedSkin skin = remembering_skin(0.05, 0);
  const SkinCalibration before = pressed_at_once(skin);
  const MemoryResult result = remembered(skin, before);
  EXPECT_TRUE(result.found);
  EXPECT_NEAR(result.hysteresis, 0.05, 0.005);
  EXPECT_LT(result.creep_per_decade, 0.003);
  EXPECT_GT(result.residual_before, 3 * result.residual_after);
  EXPECT_LT(course_error(skin, result.calibration), 0.5);
  EXPECT_GT(course_error(skin, before), 2);
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

TEST(MemoryCalibration, FindsCreep) {
  PressedSkin skin = remembering_skin(0, 0.05);
  const SkinCalibration before = pressed_at_once(skin);
  const MemoryResult result = remembered(skin, before);
  EXPECT_TRUE(result.found);
  EXPECT_NEAR(result.creep_per_decade, 0.05, 0.01);
  EXPECT_LT(result.hysteresis, 0.01);
  EXPECT_LT(course_error(skin, result.calibration), 0.5);
  EXPECT_GT(course_error(skin, before), 1);
}

TEST(MemoryCalibration, FindsBothAndADeadZone) {
  PressedSkin skin = remembering_skin(0.05, 0.05, 5);
  const MemoryResult result = remembered(skin, pressed_at_once(skin));
  EXPECT_TRUE(result.found);
  EXPECT_NEAR(result.dead_zone_counts * 320 / *result.calibration.counts_per_newton, 5, 1);
  EXPECT_LT(course_error(skin, result.calibration), 0.8);
}

TEST(MemoryCalibration, FindsBothUnderAResponseCurve) {
  PressedSkin skin = remembering_skin(0.05, 0.05, 5, 0.9);
  const SkinCalibration before = pressed_at_once(skin, ResponseModel::curve);
  const MemoryResult result = remembered(skin, before);
  EXPECT_TRUE(result.found);
  EXPECT_TRUE(result.curved);
  EXPECT_LT(course_error(skin, result.calibration), 0.8);
  EXPECT_GT(course_error(skin, before), 2);
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
