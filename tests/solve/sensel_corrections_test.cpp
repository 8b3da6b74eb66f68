// Corrections of sensels against forward models that share no code with them.

#include <gtest/gtest.h>

#include "pillarfield/processor.h"
#include "pillarfield/status.h"
#include "pressed_skin.h"
#include "simulation/effects/sensel_leak.h"
#include "simulation/effects/wire_network.h"
#include "solve/sensor_corrections.h"

namespace pillarfield {
namespace {

constexpr std::uint32_t kPatchSide = 16;   // pillars
constexpr std::size_t kPatchSensels = 32;  // of a row

/// Frames in sequence, each with what the frames before it leave.
class HostSequence {
 public:
  explicit HostSequence(const SolverPlan& plan)
      : skin_(plan.skin), processor_(open_device("host"), plan) {}

  ForceField solve(std::span<const double> readings) {
    const std::vector<float> frame(readings.begin(), readings.end());
    processor_.submit({frame.data(), SenselType::f32, skin_.rows, skin_.cols, skin_.cols});
    return ForceField(processor_.receive());
  }

 private:
  Skin skin_;
  Processor processor_;
};

// --- Response curve ---

ResponseCurve random_curve(std::mt19937& random) {
  std::uniform_real_distribution<double> step(1, 60);
  ResponseCurve curve;
  for (int knot = 0; knot < 8; ++knot) {
    curve.readings.push_back(step(random) + (knot == 0 ? 0 : curve.readings.back()));
    curve.loads.push_back(step(random) + (knot == 0 ? 0 : curve.loads.back()));
  }
  return curve;
}

TEST(ResponseCurve, PassesItsKnotsAndIncreases) {
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const ResponseCurve curve = random_curve(random);
    for (std::size_t knot = 0; knot < curve.readings.size(); ++knot) {
      EXPECT_NEAR(load_at(curve, curve.readings[knot]), curve.loads[knot], 1e-9);
    }
    double before = 0;
    for (int step = 1; step <= 1000; ++step) {
      const double reading = 0.0013 * step * curve.readings.back();
      const double load = load_at(curve, reading);
      EXPECT_GT(load, before);
      EXPECT_NEAR(reading_at(curve, load), reading, 1e-6);
      before = load;
    }
  }
}

TEST(ResponseCurve, IsStraightBetweenKnotsOnALine) {
  const ResponseCurve line = {{10, 30, 100}, {20, 60, 200}};
  for (const double reading : {1.0, 10.0, 25.0, 99.0, 300.0}) {
    EXPECT_NEAR(load_at(line, reading), 2 * reading, 1e-9);
  }
}

/// Loads come back, small ones the closest since they decide about a touch, with the noise of the
/// curve's slope.
TEST(ResponseCurve, OfAnEvenPressComesBack) {
  for (const auto& [power, rms] : {std::pair{0.8, 0.12}, {0.9, 0.05}, {1.1, 0.05}, {1.25, 0.12}}) {
    SensorEffects effects;
    for (const double reading : {5.0, 12.0, 30.0, 60.0, 100.0, 160.0, 240.0}) {
      effects.curve.readings.push_back(reading);
      effects.curve.loads.push_back(100 * std::pow(reading / 100, power));
    }
    SolverPlan plan = pressed_plan(1, 1, effects);
    plan.skin.threshold_counts = 0;
    plan.noise_counts = 1;
    plan.uncertainty = true;
    const auto solved = [&](double reading) {
      return solve_readings(plan, std::vector<double>(4, reading));
    };
    double before = 0;
    for (int half = 1; half < 600; ++half) {
      const double reading = half / 2.0;
      const ForceField force = solved(reading);
      const double load = kPressedCountsPerNewton * double{force.normal[0]};
      EXPECT_GT(load, before);
      before = load;
      const double tolerance = power > 1 && reading <= 4 ? 0.1 : 5 * rms;
      EXPECT_NEAR(load, load_at(effects.curve, reading), tolerance) << power << " " << reading;
      if (reading < 2) continue;  // The root bends within the difference.
      const double slope =
          (solved(reading + 0.25).normal[0] - solved(reading - 0.25).normal[0]) / 0.5;
      EXPECT_NEAR(force.uncertainty[Uncertainty::normal][0], slope / 2, 3e-5);
    }
  }
}

// --- Leak between sensels ---

SensorEffects with_leak(const SenselLeak& leak) {
  SensorEffects effects;
  effects.sensel_leak = leak;
  return effects;
}

/// Readings of sensels that leak: V and fractions of the four around, by the definition.
std::vector<double> leaked(const std::vector<double>& v, std::size_t cols, const SenselLeak& leak) {
  std::vector<double> readings = v;
  const auto add = [&](std::size_t to, std::size_t from, bool inside) {
    readings[to] += (inside ? leak.inside : leak.across) * v[from];
    readings[from] += (inside ? leak.inside : leak.across) * v[to];
  };
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (i % cols + 1 < cols) add(i, i + 1, i % cols % 2 == 0);
    if (i + cols < v.size()) add(i, i + cols, i / cols % 2 == 0);
  }
  return readings;
}

TEST(SenselLeak, ComesBackWithinTheWeightsThatAreCut) {
  const ForceField truth = random_patch(kPatchSide, kPatchSide, 5);
  const std::vector<double> v = loads_of(truth);
  const double range = *std::ranges::max_element(v);
  for (const SenselLeak leak : {SenselLeak{0.05, 0.02}, {0.1, 0.06}, {-0.03, 0.04}, {0, 0.05}}) {
    const std::vector<double> readings = leaked(v, kPatchSensels, leak);
    const ForceField solved =
        solve_readings(pressed_plan(kPatchSide, kPatchSide, with_leak(leak)), readings);
    const double per_second = std::abs(leak.inside * leak.across);
    const double cubes = std::pow(std::abs(leak.inside) + std::abs(leak.across), 3);
    EXPECT_LT(largest_error(solved, truth), (4 * per_second + 4 * cubes) * range + 1e-3);
    EXPECT_EQ(pressed_count(solved), pressed_count(truth)) << "unloaded sensels stay inactive";
    const ForceField ignored = solve_readings(pressed_plan(kPatchSide, kPatchSide, {}), readings);
    EXPECT_GT(largest_error(ignored, truth), 10 * largest_error(solved, truth));
  }
}

/// The last row and the last column of an odd array have no pillar.
TEST(SenselLeak, HasTheForwardModelOfTheSimulator) {
  const SenselLeak leak = {0.05, 0.02};
  for (const auto& [rows, cols] : {std::pair{32U, 32U}, {9U, 7U}}) {
    std::vector<double> v = loads_of(random_patch(kPatchSide, kPatchSide, 6));
    std::rotate(v.begin(), v.begin() + 300, v.end());  // loads at the borders, too
    v.resize(std::size_t{rows} * cols);
    const std::vector<double> expected = leaked(v, cols, leak);
    leak_between_sensels(leak, rows, cols, v);
    for (std::size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(v[i], expected[i], 1e-9);
  }
}

TEST(SenselLeak, LeavesAUniformFieldExact) {
  ForceField truth(kPatchSide, kPatchSide);
  std::ranges::fill(truth.normal, 1.0F);
  const SenselLeak leak = {0.1, 0.05};
  const ForceField solved = solve_readings(pressed_plan(kPatchSide, kPatchSide, with_leak(leak)),
                                           leaked(loads_of(truth), kPatchSensels, leak));
  for (std::size_t row = 2; row + 2 < kPatchSide; ++row) {
    for (std::size_t col = 2; col + 2 < kPatchSide; ++col) {
      EXPECT_NEAR(solved.normal[row * kPatchSide + col], 1, 1e-6);
    }
  }
}

TEST(SenselLeak, LeavesSenselsBelowTheThresholdInactive) {
  const SolverPlan plan = pressed_plan(kPatchSide, kPatchSide, with_leak({0.2, 0.1}));
  const std::vector<double> below(kPatchSensels * kPatchSensels, 0.49);  // times c_0 above 0.5
  EXPECT_EQ(pressed_count(solve_readings(plan, below)), 0);
}

// --- Memory ---

/// Readings by E6 as it is written, for one sensel.
class RememberingSensel {
 public:
  RememberingSensel(const SenselMemory& model, double interval_s)
      : model_(model),
        interval_s_(interval_s),
        plays_(model.plays.size()),
        creep_(model.creep.size()) {}

  double reading(double v) {
    double sum = v;
    for (std::size_t i = 0; i < plays_.size(); ++i) {
      plays_[i] = std::clamp(plays_[i], std::max(0.0, v - model_.plays[i].width_counts), v);
      sum += model_.plays[i].weight * plays_[i];
    }
    for (std::size_t i = 0; i < creep_.size(); ++i) {
      sum += model_.creep[i].weight * creep_[i];
      creep_[i] += -std::expm1(-interval_s_ / model_.creep[i].time_s) * (v - creep_[i]);
    }
    return sum;
  }

 private:
  SenselMemory model_;
  double interval_s_;
  std::vector<double> plays_;
  std::vector<double> creep_;
};

/// Forces on one pillar in region 1 that wander, rest, and leave it idle for up to 40 frames.
std::vector<ForceField> random_history(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> part(0, 1);
  std::vector<ForceField> frames;
  while (frames.size() < 400) {
    ForceField force(1, 1);
    const bool idle = part(random) < 0.3F;
    force.normal[0] = idle ? 0 : 0.2F + 2 * part(random);
    force.shear_x[0] = force.normal[0] * (part(random) - 0.5F);
    force.shear_y[0] = force.normal[0] * (part(random) - 0.5F);
    frames.insert(frames.end(), 1 + static_cast<std::size_t>(40 * std::pow(part(random), 4)),
                  force);
  }
  return frames;
}

/// Weights below zero raise a reading; idle blocks could not be skipped if they made it active.
TEST(SenselMemory, LeavesSenselsBelowTheThresholdInactive) {
  SensorEffects effects;
  effects.memory = {{{0, -0.5}}, {{0.01, -0.5}}};
  const SolverPlan plan = pressed_plan(1, 1, effects);
  HostSequence sequence(plan);
  for (const double reading : {200.0, 200.0, 200.0, 0.4}) {
    const ForceField solved =
        sequence.solve(std::vector<double>{reading, reading, reading, reading});
    EXPECT_EQ(pressed_count(solved), reading > 0.5 ? 1 : 0);
  }
}

/// The most by which states of 8 bits, of loads up to `load`, move a reading.
double resolution(const SenselMemory& model, double load) {
  double weights = 0;
  for (const Play& play : model.plays) weights += std::abs(play.weight);
  for (const Creep& creep : model.creep) weights += std::abs(creep.weight);
  return std::ldexp(weights * load, -8);
}

TEST(SenselMemory, OfAnyHistoryComesBack) {
  const std::vector<SenselMemory> models = {
      {{{0, 0.05}, {30, 0.04}, {100, 0.03}, {150, -0.02}}, {}},
      {{}, {{0.05, 0.1}, {3, 0.05}}},
      {{{20, 0.1}, {90, 0.05}}, {{0.2, 0.08}, {1, 0.04}}},
  };
  for (const SenselMemory& model : models) {
    SensorEffects effects;
    effects.memory = model;
    SolverPlan plan = pressed_plan(1, 1, effects);
    plan.frame_interval_s = 0.05;
    std::vector<RememberingSensel> sensels(4, {model, plan.frame_interval_s});
    HostSequence sequence(plan);
    double least_ignored = 0;
    for (const ForceField& truth : random_history(11)) {
      std::vector<double> readings = loads_of(truth);
      for (std::size_t n = 0; n < 4; ++n) readings[n] = sensels[n].reading(readings[n]);
      EXPECT_LT(largest_error(sequence.solve(readings), truth), resolution(model, 300) + 2e-3);
      least_ignored = std::max(
          least_ignored, largest_error(solve_readings(pressed_plan(1, 1, {}), readings), truth));
    }
    EXPECT_GT(least_ignored, 5) << "the history shows the effect";
  }
}

/// 30 s at 1 kHz: a frame moves the state by a hundredth of a count, its last bit is half a count.
TEST(SenselMemory, CreepsByLessThanTheLastBitOfAState) {
  const SenselMemory model = {{}, {{10, 0.1}}};
  SensorEffects effects;
  effects.memory = model;
  SolverPlan plan = pressed_plan(1, 1, effects);
  plan.frame_interval_s = 0.001;
  ForceField truth(1, 1);
  truth.normal[0] = 1.5;
  std::vector<RememberingSensel> sensels(4, {model, plan.frame_interval_s});
  HostSequence sequence(plan);
  double largest = 0;
  double ignored = 0;
  for (int frame = 0; frame < 30000; ++frame) {
    std::vector<double> readings = loads_of(truth);
    for (std::size_t n = 0; n < 4; ++n) readings[n] = sensels[n].reading(readings[n]);
    ignored = readings[0] - loads_of(truth)[0];
    largest = std::max(largest, largest_error(sequence.solve(readings), truth));
  }
  EXPECT_LT(largest, 2 * resolution(model, 150));
  EXPECT_GT(ignored, 14) << "the state has crept";
}

// --- Bending ---

/// A skin of random patterns, of about 8 counts at a radius of 50 mm.
Calibration random_patterns(std::size_t sensels) {
  std::mt19937 random(17);
  std::normal_distribution<float> pattern(0, 400);
  Calibration calibration;
  for (auto* plane : {&calibration.bend_x, &calibration.bend_y, &calibration.bend_xy}) {
    for (std::size_t i = 0; i < sensels; ++i) plane->push_back(pattern(random));
  }
  calibration.tare.assign(sensels, 40);
  return calibration;
}

TEST(Bending, IsFollowedUnderAContact) {
  const ForceField truth = random_patch(kPatchSide, kPatchSide, 19);  // 39 % of the skin
  const std::vector<double> v = loads_of(truth);
  SolverPlan plan = pressed_plan(kPatchSide, kPatchSide, {});
  plan.skin.threshold_counts = 2;
  plan.noise_counts = 0.4;
  plan.calibration = random_patterns(v.size());
  const Calibration& planes = plan.calibration;
  std::mt19937 random(23);
  std::normal_distribution<double> noise(0, 0.4);
  HostSequence sequence(plan);
  for (int frame = 0; frame < 20; ++frame) {
    const Curvature at = {0.02 - 0.001 * frame, 0.001 * frame, -0.01};
    std::vector<double> readings = v;
    for (std::size_t i = 0; i < v.size(); ++i) {
      readings[i] += planes.tare[i] + at.x * planes.bend_x[i] + at.y * planes.bend_y[i] +
                     at.xy * planes.bend_xy[i] + noise(random);
    }
    const ForceField solved = sequence.solve(readings);
    EXPECT_LT(largest_error(solved, truth), 3) << frame;
    EXPECT_LT(pressed_count(solved), pressed_count(truth) + 5) << frame;
  }
}

// --- Wires ---

SensorEffects with_wires(double ohm, std::uint32_t tile = 64) {
  SensorEffects effects;
  const double per_count = ohm / (10'000 * 255.0);  // 10 kilohms at 255 counts
  effects.wires = {tile, tile, per_count, per_count, per_count};
  return effects;
}

std::vector<double> through_wires(std::vector<double> readings, const SensorEffects& effects,
                                  std::uint32_t side) {
  read_through_wires(*effects.wires, 2 * side, 2 * side, readings);
  return readings;
}

TEST(Wires, OfTheNodalSolveComeBack) {
  const ForceField truth = random_patch(kPatchSide, kPatchSide, 9);
  const std::vector<double> v = loads_of(truth);
  for (const std::uint32_t tile : {32U, 12U}) {
    const SensorEffects effects = with_wires(50, tile);
    const std::vector<double> readings = through_wires(v, effects, kPatchSide);
    const ForceField solved =
        solve_readings(pressed_plan(kPatchSide, kPatchSide, effects), readings);
    EXPECT_LT(largest_error(solved, truth), 0.001 * 150);
    EXPECT_GT(
        largest_error(solve_readings(pressed_plan(kPatchSide, kPatchSide, {}), readings), truth),
        3);
    EXPECT_EQ(pressed_count(solved), pressed_count(truth));
  }
}

TEST(Wires, LeaveTaresThatAreAnOffset) {
  const ForceField truth = random_patch(kPatchSide, kPatchSide, 9);
  SensorEffects effects = with_wires(50, 32);
  std::vector<double> readings = through_wires(loads_of(truth), effects, kPatchSide);
  for (double& reading : readings) reading += 30;
  effects.wires->tares = TareOrigin::offset;
  SolverPlan plan = pressed_plan(kPatchSide, kPatchSide, effects);
  plan.calibration.tare.assign(readings.size(), 30);
  EXPECT_LT(largest_error(solve_readings(plan, readings), truth), 0.001 * 150);
  plan.calibration.effects.wires->tares = TareOrigin::conductance;
  EXPECT_GT(largest_error(solve_readings(plan, readings), truth), 1);
}

TEST(Wires, OfNoResistanceChangeNothing) {
  const std::vector<double> v = loads_of(random_patch(kPatchSide, kPatchSide, 9));
  const ForceField expected = solve_readings(pressed_plan(kPatchSide, kPatchSide, {}), v);
  EXPECT_EQ(solve_readings(pressed_plan(kPatchSide, kPatchSide, with_wires(0)), v).normal,
            expected.normal);
}

TEST(Wires, ThatSaturateTheReadoutAreRefused) {
  const ForceField truth = random_patch(kPatchSide, kPatchSide, 9);
  const SensorEffects effects = with_wires(5'000);
  const ForceField solved = solve_readings(pressed_plan(kPatchSide, kPatchSide, effects),
                                           through_wires(loads_of(truth), effects, kPatchSide));
  for (std::size_t i = 0; i < truth.normal.size(); ++i) {
    if (truth.normal[i] > 0) {
      EXPECT_NE(solved.status[i] & status::kInconsistent, 0);
    }
  }
}

}  // namespace
}  // namespace pillarfield
