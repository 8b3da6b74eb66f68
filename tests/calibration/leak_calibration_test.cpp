// Leaks between sensels and between pillars from a fine tip.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/quantile.h"
#include "calibration/normal_equations.h"
#include "pillarfield/calibration_steps.h"
#include "pillarfield/tare.h"
#include "tests/base/message.h"
#include "tests/calibration/pressed_skin.h"

namespace pillarfield {
namespace {

using core_test::message_of;
using core_test::PressedSkin;

/// A skin with noise 0.5 and gains of 5 % that leaks.
PressedSkin leaking_skin(const SenselLeak& sensel, const PillarLeak& pillar,
                         double dead_zone_counts = 0) {
  SensorModel sensor;
  sensor.tare_counts = 12;
  sensor.gain_spread = 0.05;
  sensor.noise_counts = 0.5;
  sensor.effects.sensel_leak = sensel;
  sensor.effects.pillar_leak = pillar;
  sensor.dead_zone_counts = dead_zone_counts;
  return {20, 20, sensor};
}

/// A tip of 0.5 N on each of 18 x 18 pillars in turn, or every `stride`-th, pulled in all
/// directions by `friction` times its force.
void press_places(PressedSkin& skin, double friction, int stride, LeakFinder& finder) {
  const double pitch = skin.skin().pillar_pitch_mm();
  const Skin& size = skin.skin();
  FrameBuffer frame(Simulator(skin.scene()).sensel_type(), size.rows, size.cols);
  ForceField truth(size.pillar_rows(), size.pillar_cols());
  std::uint64_t index = 1000;
  for (int place = 0; place < 18 * 18; place += stride) {
    Scene scene = skin.scene();
    ClosedFormContact tip;
    tip.shape = ContactShape::flat_punch;
    tip.motion = ContactMotion::slide;
    tip.friction = friction;
    const int row = place / 18;
    const int col = place % 18;
    tip.direction_deg = 37 * place % 360;
    tip.contact_radius_mm = 0.3;
    tip.reference_load_n = 0.5;
    tip.path = {{0, (col - 8.5) * pitch, (row - 8.5) * pitch, 0.5}};
    scene.load = std::vector<ClosedFormContact>{tip};
    Simulator(scene).render(index++, frame, truth);
    finder.add(frame.view());
  }
}

/// The step after equilibration under these forces on each pillar.
LeakResult found(PressedSkin& skin, double friction, int stride = 3,
                 const std::vector<double>& forces_n = {0.3}) {
  const SkinCalibration tared = skin.tared();
  LeakFinder finder(skin.skin(), skin.equilibrated(tared, forces_n).calibration);
  press_places(skin, friction, stride, finder);
  return finder.result();
}

void expect_within_errors(const LeakResult& result, const SenselLeak& sensel,
                          const PillarLeak& pillar) {
  const LeakEstimate& error = result.standard_error;
  EXPECT_NEAR(result.leak.sensel.inside, sensel.inside, 4 * error.sensel.inside);
  EXPECT_NEAR(result.leak.sensel.across, sensel.across, 4 * error.sensel.across);
  EXPECT_NEAR(result.leak.pillar.edge, pillar.edge, 4 * error.pillar.edge);
  EXPECT_NEAR(result.leak.pillar.corner, pillar.corner, 4 * error.pillar.corner);
}

TEST(LeakCalibration, FindsTheLeaksBetweenSensels) {
  PressedSkin skin = leaking_skin({0.05, 0.02}, {});
  const LeakResult result = found(skin, 2);
  expect_within_errors(result, {0.05, 0.02}, {});
  EXPECT_LT(result.standard_error.sensel.inside, 0.002);
  EXPECT_LT(result.standard_error.sensel.across, 0.001);
  EXPECT_TRUE(result.inside_known);
  EXPECT_GT(result.residual_before, 2 * result.residual_after);
  ASSERT_TRUE(result.calibration.planes.effects.sensel_leak);
  EXPECT_FALSE(result.calibration.planes.effects.pillar_leak);
  // Gains and k are those of the skin without leaks: 0.3 N on each pillar.
  const Calibration truth = skin.truth();
  const Calibration& planes = result.calibration.planes;
  const double k = *result.calibration.counts_per_newton;
  for (const std::size_t i : {std::size_t{0}, std::size_t{5}, std::size_t{820}}) {
    EXPECT_NEAR(planes.gain[i] / k, truth.gain[i] / 320, 0.01 * truth.gain[i] / 320);
  }
}

TEST(LeakCalibration, FindsTheLeaksBetweenPillarsOrNone) {
  for (const double size : {0.0, 0.01}) {
    PressedSkin skin = leaking_skin({3 * size, size}, {2 * size, size / 2});
    const LeakResult result = found(skin, 2);
    expect_within_errors(result, {3 * size, size}, {2 * size, size / 2});
    EXPECT_EQ(result.calibration.planes.effects.pillar_leak.has_value(), size > 0);
    EXPECT_LT(result.standard_error.pillar.edge, 0.001);
  }
}

/// The sensels beside a pressed pillar bear 8 counts, those at its corners less than the dead zone.
/// Dead zones come after the leak between pillars: only that between sensels scales them.
TEST(LeakCalibration, FindsWhatADeadZoneHidesInPart) {
  for (const double edge : {0.0, 0.02}) {
    PressedSkin skin = leaking_skin({0.05, 0.02}, {edge, edge / 4}, 5);
    const LeakResult result = found(skin, 2, 3, {0.1, 0.3, 0.6});
    EXPECT_NEAR(result.leak.pillar.edge, edge, 0.002);
    EXPECT_EQ(result.leak.pillar.corner, 0);
    EXPECT_NEAR(result.leak.sensel.inside, 0.05, 0.003);
    std::vector<float> zones = result.calibration.planes.dead_zone;
    EXPECT_NEAR(median(zones) * 320 / *result.calibration.counts_per_newton, 5, 0.2) << edge;
  }
}

TEST(LeakCalibration, WithoutAnInactiveSenselInsideIsUnknown) {
  PressedSkin skin = leaking_skin({0.05, 0.02}, {});
  const LeakResult result = found(skin, 0);
  EXPECT_FALSE(result.inside_known);
  EXPECT_EQ(result.leak.sensel.inside, 0);
  EXPECT_NEAR(result.leak.sensel.across, 0.02 / 1.1, 0.001);
}

/// A skin of 12 x 12 pillars whose sensels read a load and a part of what they bore more than 30
/// counts of, and of that leak 5 % inside and 2 % across: from rest on.
class LoopThenLeak {
 public:
  static constexpr double kSum = 1.14;
  static double reading(double load) { return load + 0.2 * std::max(0.0, load - 30); }

  LoopThenLeak() { skin_.rows = skin_.cols = 24; }

  /// As rising pressures find it.
  [[nodiscard]] SkinCalibration equilibrated() const {
    SkinCalibration calibration = blank_calibration(skin_);
    calibration.planes.tare.assign(skin_.sensels(), 0);
    calibration.planes.noise.assign(skin_.sensels(), 0.5);
    calibration.counts_per_newton = kSum * 320;
    set_threshold(calibration, 4);
    for (const double load : {12, 28, 60, 100, 160, 240}) {
      calibration.planes.effects.curve.readings.push_back(kSum * reading(load));
      calibration.planes.effects.curve.loads.push_back(kSum * load);
    }
    return calibration;
  }

  /// Cycles of uniform pressure.
  [[nodiscard]] MemoryResult remembered(const SkinCalibration& before) const {
    MemoryFinder finder(skin_, before);
    FrameBuffer frame(SenselType::f32, 24, 24);
    const double area_mm2 = skin_.pillar_pitch_mm() * skin_.pillar_pitch_mm();
    double held = 0;
    for (int i = 0; i < 160; ++i) {
      const double load = (i < 40 ? 5 : 11) * std::abs((i + 20) % 40 - 20);
      held = std::clamp(held, std::max(0.0, load - 30), load);
      std::ranges::fill(frame.readings<float>(), static_cast<float>(kSum * (load + 0.2 * held)));
      finder.add(frame.view(), 0.05 * i, 1000 * load / 320 / area_mm2);
    }
    return finder.result();
  }

  /// Presses of single pillars, one of whose sensels bears nothing.
  [[nodiscard]] LeakResult leaks(const SkinCalibration& before) const {
    LeakFinder finder(skin_, before);
    for (std::size_t place = 0; place < 8; ++place) {
      FrameBuffer frame(SenselType::f32, 24, 24);
      std::vector<double> own(skin_.sensels());
      const std::size_t corner = (4 + 2 * place) * 25;
      for (const auto& [at, load] : {std::pair{0, 200.0}, {1, 90.0}, {24, 60.0}}) {
        own[corner + static_cast<std::size_t>(at)] = reading(load);
      }
      for (std::size_t i = 25; i + 25 < own.size(); ++i) {
        const auto pair = [&](std::size_t step, bool odd) {
          return odd ? 0.05 * own[i - step] + 0.02 * own[i + step]
                     : 0.02 * own[i - step] + 0.05 * own[i + step];
        };
        frame.readings<float>()[i] =
            static_cast<float>(own[i] + pair(1, i % 2 != 0) + pair(24, i / 24 % 2 != 0));
      }
      finder.add(frame.view());
    }
    return finder.result();
  }

 private:
  Skin skin_;
};

/// Rising pressures take the loop for a response curve, under which leaks are read too large.
TEST(LeakCalibration, FollowsTheMemoryOfALoop) {
  const LoopThenLeak skin;
  const LeakResult biased = skin.leaks(skin.equilibrated());
  EXPECT_GT(biased.leak.sensel.inside, 0.055);
  const LeakResult result = skin.leaks(skin.remembered(skin.equilibrated()).calibration);
  EXPECT_NEAR(result.leak.sensel.inside, 0.05, 0.001);
  EXPECT_NEAR(result.leak.sensel.across, 0.02, 0.001);
  // The plays are in counts of a load without leaks.
  const SenselMemory& memory = *result.calibration.planes.effects.memory;
  EXPECT_NEAR(memory.plays[0].width_counts, 220.0 / 8, 1);
  EXPECT_NE(message_of([&] {
              (void)skin.remembered(biased.calibration);
            }).find("calibrate the memory before the leak"),
            std::string::npos);
}

TEST(LeakCalibration, RefusesFramesWithoutIsolatedPillars) {
  PressedSkin skin = leaking_skin({}, {});
  const SkinCalibration tared = skin.tared();
  LeakFinder finder(skin.skin(), skin.equilibrated(tared, {0.3}).calibration);
  const auto message = [&] { return message_of([&] { (void)finder.result(); }); };
  Scene scene = skin.scene();
  scene.load = DirectionSweep{.directions = 20, .inclinations = 20, .magnitudes_n = {0.5}};
  FrameBuffer frame(SenselType::f32, 40, 40);
  ForceField truth(20, 20);
  Simulator(scene).render(0, frame, truth);
  finder.add(frame.view());
  EXPECT_NE(message().find("no frame shows an isolated pressed pillar"), std::string::npos);
  EXPECT_NE(message_of([&] {
              LeakFinder(skin.skin(), blank_calibration(skin.skin()));
            }).find("take the tare"),
            std::string::npos);
}

TEST(NonNegativeLeastSquares, LeavesOutWhatWouldBeNegative) {
  NormalEquations equations(3);
  const double rows[][3] = {{1, 0, 1}, {0, 1, 1}, {1, 1, 0}, {1, 2, 3}};
  // x = (2, −1, 1) solves all of them; the nearest non-negative one lacks the second.
  for (const auto& row : rows) equations.add(row, 2 * row[0] - row[1] + row[2]);
  const std::vector<double> free = *equations.solve({true, true, true});
  EXPECT_NEAR(free[1], -1, 1e-9);
  const std::vector<double> x = equations.solve_non_negative({true, true, true});
  const std::vector<double> expected = *equations.solve({true, false, true});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(x[i], expected[i], 1e-9);
  EXPECT_GE(expected[2], 0);
}

}  // namespace
}  // namespace pillarfield
