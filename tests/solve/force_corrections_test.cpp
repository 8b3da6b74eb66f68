// Corrections of forces: the shear coefficient, leaks between pillars, off-centre pressure.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "pillarfield/component_ends.h"
#include "pillarfield/error.h"
#include "pillarfield/status.h"
#include "pressed_skin.h"
#include "solve/pillar_maths.h"

namespace pillarfield {
namespace {

namespace maths = double_precision;

// --- Shear coefficient ---

/// A force on one pillar, from any direction.
ForceField random_force(std::mt19937& random) {
  std::uniform_real_distribution<double> part(0, 1);
  const double cosine = part(random);
  const double phi = 2 * std::numbers::pi * part(random);
  ForceField force(1, 1);
  force.normal[0] = static_cast<float>(2 * cosine);
  const double shear = 2 * std::sqrt(1 - cosine * cosine);
  force.shear_x[0] = static_cast<float>(shear * std::cos(phi));
  force.shear_y[0] = static_cast<float>(shear * std::sin(phi));
  return force;
}

float end_of(const ForceField& solved, Uncertainty end) { return solved.uncertainty[end][0]; }

/// True if an angle lies in the interval of phi of a solved pillar, which may cross pi.
bool holds_phi(const ForceField& solved, double phi) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const double low = end_of(solved, Uncertainty::phi_low) - 1e-4;
  const double width = end_of(solved, Uncertainty::phi_high) - low;
  return std::remainder(phi - low - kTurn / 2, kTurn) + kTurn / 2 <=
         width + (width < 0 ? kTurn : 0) + 2e-4;
}

void expect_inside_ends(const ForceField& solved, const ForceField& truth) {
  const double x = truth.shear_x[0];
  const double y = truth.shear_y[0];
  const double theta = std::atan2(std::hypot(x, y), truth.normal[0]);
  EXPECT_GE(theta, end_of(solved, Uncertainty::theta_low) - 1e-4);
  EXPECT_LE(theta, end_of(solved, Uncertainty::theta_high) + 1e-4);
  EXPECT_TRUE(holds_phi(solved, std::atan2(-y, -x)));
  const double magnitude = std::hypot(x, y, truth.normal[0]);
  EXPECT_GE(magnitude, end_of(solved, Uncertainty::magnitude_low) - 1e-4);
  EXPECT_LE(magnitude, end_of(solved, Uncertainty::magnitude_high) + 1e-4);
}

TEST(ShearCoefficient, ComesBackInAllRegions) {
  std::mt19937 random(13);
  std::array<int, kRegions> seen{};
  for (const ShearCoefficient c : {ShearCoefficient{0.9, 0.9}, {0.3, 2}, {1.5, 0.7}}) {
    SensorEffects effects;
    effects.shear_coefficient = c;
    SolverPlan plan = pressed_plan(1, 1, effects);
    plan.noise_counts = 0.01;
    plan.uncertainty = true;
    for (int i = 0; i < 1000; ++i) {
      const ForceField truth = random_force(random);
      const ForceField solved = solve_readings(plan, loads_of(truth, c));
      const Region region = region_of(solved.status[0]);
      ++seen.at(static_cast<std::size_t>(region));
      expect_inside_ends(solved, truth);
      if (region != Region::one && region != Region::two) continue;
      // An inactive sensel may hide half a count.
      EXPECT_LT(largest_error(solved, truth),
                region == Region::one ? 0.001 : 0.6 / c.x + 0.6 / c.y);
    }
  }
  for (const Region region : {Region::one, Region::two, Region::three}) {
    EXPECT_GT(seen.at(static_cast<std::size_t>(region)), 200);
  }
}

// --- Leak between pillars ---

/// Forces that leaking pillars carry under these ones, which are zero at the skin's edge.
ForceField carried(const ForceField& truth, const PillarLeak& leak) {
  ForceField sum(truth.rows, truth.cols);
  const auto side = static_cast<int>(truth.cols);
  for (const auto plane : {&ForceField::shear_x, &ForceField::shear_y, &ForceField::normal}) {
    for (int at = side + 1; at < side * (side - 1) - 1; ++at) {
      double all = 0;
      for (const int step : {-side - 1, -side, -side + 1, -1, 0, 1, side - 1, side, side + 1}) {
        const bool beside = std::abs(step) == 1 || std::abs(step) == side;
        const double part = step == 0 ? 1 : beside ? leak.edge : leak.corner;
        const int other = at + step;
        all += part * (truth.*plane)[static_cast<std::size_t>(other)];
      }
      (sum.*plane)[static_cast<std::size_t>(at)] = static_cast<float>(all);
    }
  }
  return sum;
}

/// The largest error of a patch of random forces read through a leak, counts; unset if the solve
/// refuses the leak.
std::optional<double> error_through(const PillarLeak& leak) {
  const ForceField truth = random_patch(14, 14, 21);
  SensorEffects effects;
  effects.pillar_leak = leak;
  try {
    return largest_error(
        solve_readings(pressed_plan(14, 14, effects), loads_of(carried(truth, leak))), truth);
  } catch (const Error&) {
    return std::nullopt;
  }
}

TEST(PillarLeak, ComesBackWithinWhatTheWeightsLeave) {
  EXPECT_LT(error_through({0.02, 0.005}), 0.4);
  EXPECT_LT(error_through({0.04, 0.01}), 1.2);
  EXPECT_LT(error_through({0.1, 0.02}), 7);
}

/// Forces are about 100 counts.
TEST(PillarLeak, ComesBackOrIsRefused) {
  for (const double edge : {-0.2, -0.1, -0.05, 0.0, 0.05, 0.1, 0.2}) {
    for (const double corner : {-0.2, -0.1, -0.05, 0.0, 0.05, 0.1, 0.2}) {
      EXPECT_LT(error_through({edge, corner}).value_or(0), 40) << edge << ", " << corner;
    }
  }
  EXPECT_EQ(error_through({0.2, 0.1}), std::nullopt);
}

// --- Off-centre pressure ---

/// The sensels read the moment over the arm as shear, + towards the higher pressure.
TEST(Lean, IsTakenFromTheShear) {
  constexpr std::uint32_t kSide = 9;
  SensorEffects effects;
  effects.arm_mm = 0.3;
  SolverPlan plan = pressed_plan(kSide, kSide, effects);
  const double pitch = plan.skin.pillar_pitch_mm();
  ForceField truth(kSide, kSide);
  ForceField read(kSide, kSide);
  for (std::size_t i = 0; i < truth.normal.size(); ++i) {
    const std::size_t row = i / kSide;
    const auto right = static_cast<double>(i % kSide);
    const auto up = -static_cast<double>(row);
    truth.normal[i] = static_cast<float>(2 + 0.03 * right + 0.02 * up);
    read.normal[i] = truth.normal[i];
    read.shear_x[i] = static_cast<float>(2 * 0.03 / 24 * pitch / *effects.arm_mm);
    read.shear_y[i] = static_cast<float>(2 * 0.02 / 24 * pitch / *effects.arm_mm);
  }
  const ForceField solved = solve_readings(plan, loads_of(read));
  for (std::size_t row = 3; row + 3 < kSide; ++row) {
    for (std::size_t col = 3; col + 3 < kSide; ++col) {
      EXPECT_NEAR(solved.shear_x[row * kSide + col], 0, 1e-5);
      EXPECT_NEAR(solved.shear_y[row * kSide + col], 0, 1e-5);
    }
  }
}

/// Pillars at the edge of a pressure that ends in their middle. Their lean hides the shear of those
/// of the upper rows, which alone would lift two sensels.
TEST(Lean, FlagsPillarsWhoseForceAloneWouldLoadOtherSensels) {
  constexpr std::uint32_t kSide = 12;
  SensorEffects effects;
  effects.arm_mm = 0.5;
  const SolverPlan plan = pressed_plan(kSide, kSide, effects);
  ForceField read(kSide, kSide);
  for (std::size_t i = 0; i < read.normal.size(); ++i) {
    const std::size_t col = i % kSide;
    read.normal[i] = col < 5 ? 1.0F : (col == 5 ? 0.5F : 0.0F);
    if (col != 5) continue;
    const double lean = -0.125 * plan.skin.pillar_pitch_mm() / *effects.arm_mm;
    read.shear_x[i] = static_cast<float>(lean + (i / kSide < kSide / 2 ? 0.9 : 0.0));
  }
  const ForceField solved = solve_readings(plan, loads_of(read));
  for (std::size_t row = 2; row + 2 < kSide; ++row) {
    const auto flagged = [&](std::size_t col) {
      return (solved.status[row * kSide + col] & status::kAmbiguous) != 0;
    };
    EXPECT_EQ(solved.status[row * kSide + 5] & status::kUsable, status::kUsable);
    if (row + 1 < kSide / 2) {
      EXPECT_TRUE(flagged(5)) << row;
    }
    if (row > kSide / 2) {
      EXPECT_FALSE(flagged(5)) << row;
    }
    EXPECT_FALSE(flagged(2));
  }
}

/// A masked or saturated sensel may bear the load that the force alone gives it.
TEST(Lean, DoesNotFlagPillarsWithAnUnknownSensel) {
  SensorEffects effects;
  effects.arm_mm = 0.5;
  for (const bool saturated : {false, true}) {
    SolverPlan plan = pressed_plan(5, 5, effects);
    plan.skin.full_scale_counts = 250;
    FrameBuffer frame(plan.sensel_type, 10, 10);
    for (float& reading : frame.readings<float>()) reading = 200;
    if (saturated) frame.readings<float>()[44] = 255;
    if (!saturated) {
      plan.calibration.mask.assign(100, kGood);
      plan.calibration.mask[44] = kMissing;
    }
    const ForceField solved = solve_on_host(plan, frame.view());
    EXPECT_EQ(solved.status[12] & status::kUsable, status::kUsable & ~status::kSensel2);
    EXPECT_EQ(solved.status[12] & status::kAmbiguous, 0) << saturated;
  }
}

// --- The ratio of shear to normal force ---

/// A constant pressure with an edge at an angle, or a stripe of it, and a shear of 0.3 of it.
struct EdgedPressure {
  ForceField force{14, 14};
  std::array<std::vector<double>, 2> moments;  ///< along x and y, over the pitch, N

  explicit EdgedPressure(double angle, double width = 100) {
    constexpr int kParts = 32;
    for (auto& moment : moments) moment.resize(force.normal.size());
    for (std::size_t i = 0; i < force.normal.size(); ++i) {
      for (int part = 0; part < kParts * kParts; ++part) {
        const int part_row = part / kParts;
        const std::size_t row = i / 14;
        const double x = (part % kParts + 0.5) / kParts - 0.5;
        const double y = 0.5 - (part_row + 0.5) / kParts;
        const double beyond = std::cos(angle) * (x + static_cast<double>(i % 14) - 6.6) +
                              std::sin(angle) * (y + 6.7 - static_cast<double>(row));
        if (beyond > 0 || beyond < -width) continue;
        force.normal[i] += 1.0F / (kParts * kParts);
        moments[0][i] += x / (kParts * kParts);
        moments[1][i] += y / (kParts * kParts);
      }
      force.shear_x[i] = 0.3F * force.normal[i];
    }
  }

  /// Lean along x by E7.
  [[nodiscard]] double lean_x(std::size_t i) const {
    const auto at = [&](std::size_t place) { return static_cast<double>(force.normal[place]); };
    return maths::lean_between(at(i - 2), at(i - 1), at(i), at(i + 1), at(i + 2)).moment;
  }
};

TEST(ShearRatio, OfThePillarsAroundBringsTheShearBack) {
  SensorEffects effects;
  effects.arm_mm = 0.5;
  const SolverPlan plan = pressed_plan(14, 14, effects);
  const double per_arm = plan.skin.pillar_pitch_mm() / *effects.arm_mm;
  double alone = 0;
  double left = 0;
  for (const double angle : {0.3, 0.7, 1.2, 2.0, -0.5, -2.6}) {
    const EdgedPressure pressed(angle);
    ForceField read = pressed.force;
    for (std::size_t i = 0; i < read.normal.size(); ++i) {
      read.shear_x[i] += static_cast<float>(per_arm * pressed.moments[0][i]);
      read.shear_y[i] += static_cast<float>(per_arm * pressed.moments[1][i]);
    }
    const ForceField solved = solve_readings(plan, loads_of(read));
    for (std::size_t i = 0; i < read.normal.size(); ++i) {
      const bool inside = i / 14 >= 3 && i / 14 < 11 && i % 14 >= 3 && i % 14 < 11;
      if (!inside || (solved.status[i] & status::kUsable) != status::kUsable) continue;
      alone += std::pow(per_arm * (pressed.lean_x(i) - pressed.moments[0][i]), 2);
      left += std::pow(solved.shear_x[i] - pressed.force.shear_x[i], 2);
    }
  }
  EXPECT_GT(alone, 0.05);
  EXPECT_LT(left, 0.65 * alone);
}

/// A stripe of two pillars, of which E7 sees too little: the pillars around disagree.
TEST(ShearRatio, StatesWhatIsLeftUnderANarrowBody) {
  SensorEffects effects;
  effects.arm_mm = 0.5;
  SolverPlan plan = pressed_plan(14, 14, effects);
  plan.noise_counts = 0.5;
  plan.uncertainty = true;
  const double per_arm = plan.skin.pillar_pitch_mm() / *effects.arm_mm;
  int held = 0;
  int all = 0;
  for (const double angle : {0.1, 0.3, 0.5, 0.7, 1.0, 1.3, 2.0}) {
    const EdgedPressure pressed(angle, 1.8);
    ForceField read = pressed.force;
    for (std::size_t i = 0; i < read.normal.size(); ++i) {
      read.shear_x[i] += static_cast<float>(per_arm * pressed.moments[0][i]);
      read.shear_y[i] += static_cast<float>(per_arm * pressed.moments[1][i]);
    }
    const ForceField solved = solve_readings(plan, loads_of(read));
    for (std::size_t i = 0; i < read.normal.size(); ++i) {
      if (!is_determined(solved.status[i])) continue;
      const auto ends = component_ends(solved.view(), i, plan.segment_point);
      held += ends[0] <= pressed.force.shear_x[i] && pressed.force.shear_x[i] <= ends[1] ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(all, 200);
  EXPECT_GT(held, 0.93 * all);
}

TEST(ShearRatio, IsMirroredWithTheForces) {
  constexpr std::uint32_t kSide = 12;
  SensorEffects effects;
  effects.arm_mm = 0.3;
  const SolverPlan plan = pressed_plan(kSide, kSide, effects);
  const ForceField forces = random_patch(kSide, kSide, 5);
  ForceField mirrored = forces;
  const auto twin = [](std::size_t i) { return i / kSide * kSide + kSide - 1 - i % kSide; };
  for (std::size_t i = 0; i < forces.normal.size(); ++i) {
    mirrored.normal[twin(i)] = forces.normal[i];
    mirrored.shear_x[twin(i)] = -forces.shear_x[i];
    mirrored.shear_y[twin(i)] = forces.shear_y[i];
  }
  const ForceField a = solve_readings(plan, loads_of(forces));
  const ForceField b = solve_readings(plan, loads_of(mirrored));
  for (std::size_t i = 0; i < forces.normal.size(); ++i) {
    EXPECT_NEAR(b.shear_x[twin(i)], -a.shear_x[i], 1e-5);
    EXPECT_NEAR(b.shear_y[twin(i)], a.shear_y[i], 1e-5);
  }
}

// --- Intervals of corrected forces ---

/// Forces of the segment of a pillar with two adjacent usable sensels, as the interval assumes.
maths::Force on_segment(const maths::Force& force, int bits, double slope, double normal) {
  const bool along_y = bits == 3 || bits == 12;
  const double down = bits == 12 || bits == 6 ? -slope : slope;
  maths::Force moved = force;
  (along_y ? moved.shear_y : moved.shear_x) += down * (force.normal - normal);
  moved.normal = normal;
  return moved;
}

TEST(CorrectedInterval, HoldsTheSegmentAndReachesItsEnds) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> part(0, 1);
  const maths::ShearWeights weights = {1 / 0.8, 1 / 1.3, false};
  for (int i = 0; i < 400; ++i) {
    const std::array<int, 4> pairs = {3, 6, 12, 9};
    const int bits = pairs.at(static_cast<std::size_t>(i) % pairs.size());
    const maths::Force force = {3 * part(random) - 1.5, 3 * part(random) - 1.5, part(random)};
    const double slope = std::numbers::sqrt2 * (bits == 3 || bits == 12 ? weights.y : weights.x);
    const auto interval =
        maths::corrected_interval({}, force, maths::direction_of(force),
                                  static_cast<maths::Bits>(bits), kSegmentPoint, 0, weights);
    double theta_low = 9;
    double low = 1e9;
    double high = 0;
    for (int sample = 1; sample <= 2000; ++sample) {
      const maths::Force at =
          on_segment(force, bits, slope, force.normal / kSegmentPoint * sample / 2000);
      const auto direction = maths::direction_of(at);
      theta_low = std::min(theta_low, direction.theta);
      low = std::min(low, direction.magnitude);
      high = std::max(high, direction.magnitude);
      const double turn = std::remainder(direction.phi - interval.phi_low, 2 * std::numbers::pi);
      const double width =
          std::remainder(interval.phi_high - interval.phi_low, 2 * std::numbers::pi);
      EXPECT_GE(turn, -1e-9);
      EXPECT_LE(turn, width + 1e-9);
    }
    EXPECT_NEAR(interval.theta_low, theta_low, 2e-3);
    EXPECT_NEAR(interval.magnitude_low, low, 2e-3);
    EXPECT_NEAR(interval.magnitude_high, high, 2e-2);
    EXPECT_GE(interval.magnitude_high, high - 1e-9);
  }
}

// --- What calibration leaves ---

/// One pillar of one count per newton that reads these four values.
ForceField solve_readings(const std::array<float, 4>& v, const SensorEffects& effects) {
  SolverPlan plan = pressed_plan(1, 1, effects);
  plan.sensel_type = SenselType::f32;
  plan.skin.counts_per_newton = 1;
  plan.noise_counts = 2;
  plan.uncertainty = true;
  const std::array<float, 4> frame = {v[1], v[0], v[2], v[3]};
  return solve_on_host(plan, {frame.data(), SenselType::f32, 2, 2, 2});
}

/// The part in proportion once for each sensel and once for the pillar, the constant part for the
/// pillar's normal force.
TEST(Residual, WidensDeviations) {
  SensorEffects effects;
  effects.residual = {0.05, 3};
  const std::array<double, 4> v = {140, 120, 60, 80};
  const ForceField solved = solve_readings({140, 120, 60, 80}, effects);
  double variance = 0;
  for (const double reading : v) variance += 4 + std::pow(0.05 * reading, 2);
  // The normal force is a quarter of the sum, the shear a sum and difference over 2 sqrt(2).
  EXPECT_NEAR(end_of(solved, Uncertainty::normal),
              std::hypot(std::sqrt(variance) / 4, 0.05 * solved.normal[0], 3), 1e-3);
  EXPECT_NEAR(end_of(solved, Uncertainty::shear_x),
              std::hypot(std::sqrt(variance / 8), 0.05 * solved.shear_x[0]), 1e-3);
}

TEST(Residual, FlagsRegionsThatItCouldChange) {
  // Parity predicts -30 counts for the fourth sensel.
  const std::array<float, 4> v = {100, 30, 0, 40};
  const auto is_flagged = [&](const ResidualError& residual) {
    SensorEffects effects;
    effects.residual = residual;
    return (solve_readings(v, effects).status[0] & status::kAmbiguous) != 0;
  };
  EXPECT_FALSE(is_flagged({0, 0}));
  EXPECT_TRUE(is_flagged({0.05, 0}));
  EXPECT_TRUE(is_flagged({0, 4}));
}

}  // namespace
}  // namespace pillarfield
