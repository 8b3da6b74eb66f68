// Deviations against derivatives taken by differences; the ends against sampled sets of forces.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "pillarfield/force_field.h"
#include "pillars.h"

namespace pillarfield {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kCountsOfOneNewton = 50;
using Components = std::array<double, 3>;

template <class Force>
Components components(const Force& force) {
  return {static_cast<double>(force.shear_x), static_cast<double>(force.shear_y),
          static_cast<double>(force.normal)};
}

template <class Precision>
class Deviations : public testing::Test {
 protected:
  using Real = RealOf<Precision>;
  static Components of(const PillarOf<Precision>& pillar, const std::array<Real, 4>& noise,
                       double segment_point = kSegmentPoint) {
    const auto solved = solve<Precision>(pillar, kCountsOfOneNewton, segment_point);
    return components(force_deviations(pillar, solved.diagonals, solved.sum,
                                       {noise[0], noise[1], noise[2], noise[3]},
                                       static_cast<Real>(segment_point), solved.scale));
  }
};
TYPED_TEST_SUITE(Deviations, Precisions, PrecisionNames);

TYPED_TEST(Deviations, AreTheClosedFormsOfRegionsOneToThree) {
  const double unit = 2 / kCountsOfOneNewton;
  const auto region_1 = TestFixture::of(pillar_of<TypeParam>({30, 20, 25, 35}), {2, 2, 2, 2});
  EXPECT_NEAR(region_1[0], unit / std::numbers::sqrt2, 1e-8);
  EXPECT_NEAR(region_1[1], unit / std::numbers::sqrt2, 1e-8);
  EXPECT_NEAR(region_1[2], unit / 2, 1e-8);
  const auto region_2 = TestFixture::of(pillar_of<TypeParam>({30, 60, 25, 0}), {2, 2, 2, 2});
  EXPECT_NEAR(region_2[0], unit, 1e-8);
  EXPECT_NEAR(region_2[1], unit, 1e-8);
  EXPECT_NEAR(region_2[2], unit / std::numbers::sqrt2, 1e-8);
}

/// 30 counts are the largest parity sum, 30 / 2k the largest normal force. Noise alone, by the
/// derivatives of the force: those of s_y are 1 - part and 1 over sqrt(2) k, of N part / 2k.
TYPED_TEST(Deviations, OfRegionThreeHoldWhatFrictionLeavesOfTheSegmentToo) {
  const double unit = 2 / kCountsOfOneNewton;
  const double high = 30 / (2 * kCountsOfOneNewton);
  for (const auto& [part, spread] :
       {std::pair{kSegmentPoint, 0.12}, {0.5, std::hypot(0.12, 0.375)}}) {
    const auto region_3 = TestFixture::of(pillar_of<TypeParam>({30, 60, 0, 0}), {2, 2, 2, 2}, part);
    const double of_y = unit * std::hypot(1 - part, 1) / std::numbers::sqrt2;
    EXPECT_NEAR(region_3[0], unit, 1e-8);
    EXPECT_NEAR(region_3[1], std::hypot(of_y, std::numbers::sqrt2 * spread * high), 1e-7);
    EXPECT_NEAR(region_3[2], std::hypot(unit * part / 2, spread * high), 1e-7);
    const auto turned = TestFixture::of(pillar_of<TypeParam>({30, 0, 0, 60}), {2, 2, 2, 2}, part);
    EXPECT_NEAR(turned[0], region_3[1], 1e-7);
    EXPECT_NEAR(turned[1], region_3[0], 1e-7);
  }
}

/// One usable sensel behind a threshold of 8 counts: the parity sum lies in [0, 16].
TYPED_TEST(Deviations, OfRegionFourAreThoseOfTheWholeInterval) {
  const auto region_4 = TestFixture::of(pillar_of<TypeParam>({30, 0, 0, 0}, 8), {0, 0, 0, 0});
  const double high = 16 / (2 * kCountsOfOneNewton);
  EXPECT_NEAR(region_4[2], high / std::sqrt(12.0), 1e-8);
  EXPECT_NEAR(region_4[0], region_4[2] / std::numbers::sqrt2, 1e-8);
  EXPECT_NEAR(region_4[1], region_4[2] / std::numbers::sqrt2, 1e-8);
}

/// Deviation due to the ambiguity of the parity sum: the force is linear in it.
Components deviations_by_ambiguity(const Solved<Double>& solved, double spread) {
  const auto low = components(solved.low());
  const auto high = components(solved.high());
  Components added{};
  for (std::size_t i = 0; i < 3; ++i) added[i] = spread * (high[i] - low[i]);
  return added;
}

bool has_saturated(const States& states) {
  return std::ranges::count(states, State::saturated) > 0;
}

/// The estimate is linear where it has no kink: differences of it are its derivatives.
Components deviations_by_differences(const States& states, const std::array<double, 4>& readings,
                                     const std::array<double, 4>& noise) {
  constexpr double kStep = 1e-3;
  Components variances{};
  for (std::size_t n = 0; n < 4; ++n) {
    auto more = readings;
    auto less = readings;
    more[n] += kStep;
    less[n] -= kStep;
    const auto high =
        components(solve<Double>(pillar_in<Double>(states, more), kCountsOfOneNewton).force);
    const auto low =
        components(solve<Double>(pillar_in<Double>(states, less), kCountsOfOneNewton).force);
    for (std::size_t i = 0; i < 3; ++i) {
      const double part = (high[i] - low[i]) / (2 * kStep) * noise[n];
      variances[i] += part * part;
    }
  }
  return {std::sqrt(variances[0]), std::sqrt(variances[1]), std::sqrt(variances[2])};
}

TEST(Deviations, AreThoseOfTheEstimateForAllStates) {
  Random random(71);
  for (const States& states : all_states()) {
    if (has_saturated(states)) continue;
    for (int i = 0; i < 20; ++i) {
      std::array<double, 4> readings{};
      std::array<double, 4> noise{};
      for (auto& reading : readings) reading = random.uniform(10, 100);
      for (auto& sigma : noise) sigma = random.uniform(0.1, 3);
      const auto pillar = pillar_in<Double>(states, readings);
      const auto solved = solve<Double>(pillar, kCountsOfOneNewton);
      const auto actual = components(force_deviations(pillar, solved.diagonals, solved.sum,
                                                      {noise[0], noise[1], noise[2], noise[3]},
                                                      kSegmentPoint, solved.scale));
      const auto expected = deviations_by_differences(states, readings, noise);
      const bool is_halved = 2 * solved.sum.point == solved.sum.high;
      const auto ambiguity =
          deviations_by_ambiguity(solved, is_halved ? 1 / std::sqrt(12.0) : 0.12);
      for (std::size_t part = 0; part < 3; ++part) {
        EXPECT_NEAR(actual[part], std::hypot(expected[part], ambiguity[part]), 1e-9)
            << name_of(states) << ", part " << part;
      }
    }
  }
}

/// A force that is consistent with readings, as parity sum and differences
/// (docs/derivations/pillar_model.md, M4, M5).
struct ConsistentForce {
  double sum;
  double rising;
  double falling;

  [[nodiscard]] double theta() const { return std::atan2(std::hypot(rising, falling), sum); }
  [[nodiscard]] double phi() const { return std::atan2(-(rising + falling), falling - rising); }
  [[nodiscard]] double magnitude() const {
    return std::hypot(sum, rising, falling) / (2 * kCountsOfOneNewton);
  }
  [[nodiscard]] std::array<double, 4> readings() const {
    return {(sum + rising) / 2, (sum + falling) / 2, (sum - rising) / 2, (sum - falling) / 2};
  }
};

constexpr double kHidden = 20;  // bound of inactive sensels: a threshold of 8 and a dead zone of 12

template <class Precision>
PillarOf<Precision> hiding_pillar(const std::array<double, 4>& readings) {
  using Real = RealOf<Precision>;
  const auto sensel = [](double reading) {
    return fill_dead_zone(
        classify(Precision::raw_sensel(static_cast<Real>(reading) - Real{12}), Real{8}), Real{12});
  };
  return {sensel(readings[0]), sensel(readings[1]), sensel(readings[2]), sensel(readings[3])};
}

template <class Precision>
struct Ends {
  decltype(direction_interval(PillarOf<Precision>{}, {}, {}, {}, {}, {})) interval;
  double slack;

  explicit Ends(const PillarOf<Precision>& pillar)
      : slack(64 * std::numeric_limits<RealOf<Precision>>::epsilon()) {
    const auto solved = solve<Precision>(pillar, kCountsOfOneNewton);
    interval =
        open_interval(direction_interval(pillar, solved.diagonals, solved.sum,
                                         direction_of(solved.force), solved.scale, {1, 1, true}),
                      open_components(pillar, solved.diagonals, solved.sum));
  }

  /// Counter-clockwise angles of phi and of phi_high from phi_low.
  [[nodiscard]] double turn(double phi) const {
    const double angle = std::remainder(phi - static_cast<double>(interval.phi_low), 2 * kHalfTurn);
    return angle < -slack ? angle + 2 * kHalfTurn : angle;
  }
  [[nodiscard]] double turn_high() const {
    if (interval.phi_high - interval.phi_low > 6) return 2 * kHalfTurn;
    return turn(static_cast<double>(interval.phi_high));
  }
};

template <class Precision>
class DirectionIntervals : public testing::Test {
 protected:
  static void expect_holds(const Ends<Precision>& ends, const ConsistentForce& truth) {
    const auto& interval = ends.interval;
    EXPECT_GE(truth.theta(), static_cast<double>(interval.theta_low) - ends.slack);
    EXPECT_LE(truth.theta(), static_cast<double>(interval.theta_high) + ends.slack);
    EXPECT_GE(truth.magnitude(), static_cast<double>(interval.magnitude_low) * (1 - ends.slack));
    EXPECT_LE(truth.magnitude(), static_cast<double>(interval.magnitude_high) * (1 + ends.slack));
    if (truth.theta() < 1e-3) return;  // phi is undefined.
    EXPECT_LE(ends.turn(truth.phi()), ends.turn_high() + ends.slack / truth.theta());
  }
};
TYPED_TEST_SUITE(DirectionIntervals, Precisions, PrecisionNames);

ConsistentForce random_truth(Random& random) {
  const auto force = random.force(random.decades(0.05, 4));
  const double k = kCountsOfOneNewton;
  return {2 * k * force.normal, std::numbers::sqrt2 * k * (force.shear_x + force.shear_y),
          std::numbers::sqrt2 * k * (force.shear_y - force.shear_x)};
}

TYPED_TEST(DirectionIntervals, HoldTheTruthWhateverIsInactive) {
  Random random(72);
  std::array<int, 5> usable{};
  for (int i = 0; i < 100'000; ++i) {
    const ConsistentForce truth = random_truth(random);
    const auto readings = truth.readings();
    ++usable[static_cast<std::size_t>(
        std::ranges::count_if(readings, [](double v) { return v > kHidden; }))];
    TestFixture::expect_holds(Ends<TypeParam>(hiding_pillar<TypeParam>(readings)), truth);
  }
  for (const int cases : usable) EXPECT_GT(cases, 1'000);
}

/// The extremes over consistent forces: equal usable readings, the other sensels inactive.
struct Reached {
  double theta_low = kHalfTurn;
  double theta_high = 0;
  double turn_low = 2 * kHalfTurn;
  double turn_high = 0;
  double magnitude_low = std::numeric_limits<double>::infinity();
  double magnitude_high = 0;

  void add(const ConsistentForce& force, const Ends<Double>& ends) {
    theta_low = std::min(theta_low, force.theta());
    theta_high = std::max(theta_high, force.theta());
    magnitude_low = std::min(magnitude_low, force.magnitude());
    magnitude_high = std::max(magnitude_high, force.magnitude());
    turn_low = std::min(turn_low, std::abs(ends.turn(force.phi())));
    turn_high = std::max(turn_high, ends.turn(force.phi()));
  }
};

/// True if a force has the usable readings and leaves the other sensels inactive.
bool is_consistent(const ConsistentForce& force, const std::array<double, 4>& readings) {
  const auto back = force.readings();
  for (std::size_t n = 0; n < 4; ++n) {
    const bool usable = readings[n] > kHidden;
    if (usable ? std::abs(back[n] - readings[n]) > 1e-9 : back[n] > kHidden) return false;
  }
  return true;
}

/// Scans the forces that are consistent with readings: parity sums, and differences of inactive
/// diagonals.
Reached scan(const std::array<double, 4>& readings, const Ends<Double>& ends) {
  constexpr int kSteps = 400;
  Reached reached;
  const auto differences = [&](double sum, double p, double q) {
    if (p > kHidden) return std::vector<double>{2 * p - sum};
    if (q > kHidden) return std::vector<double>{sum - 2 * q};
    std::vector<double> all;
    const double most = 2 * kHidden - sum;
    for (int i = -20; i <= 20; ++i) all.push_back(most * i / 20);
    return all;
  };
  for (int i = 0; i <= kSteps; ++i) {
    const double sum = 4.0 * kHidden * i / kSteps;
    for (const double rising : differences(sum, readings[0], readings[2])) {
      for (const double falling : differences(sum, readings[1], readings[3])) {
        const ConsistentForce force = {sum, rising, falling};
        if (is_consistent(force, readings)) reached.add(force, ends);
      }
    }
  }
  return reached;
}

TEST(DirectionIntervals, EndWhereConsistentForcesEnd) {
  const std::array<std::array<double, 4>, 7> idle_somewhere = {{
      {30, 40, 0, 0},
      {0, 50, 21, 0},
      {38, 0, 0, 38},
      {60, 0, 0, 0},
      {0, 0, 25, 0},
      {0, 0, 0, 200},
      {0, 0, 0, 0},
  }};
  for (const auto& readings : idle_somewhere) {
    SCOPED_TRACE(testing::Message()
                 << readings[0] << ' ' << readings[1] << ' ' << readings[2] << ' ' << readings[3]);
    const Ends<Double> ends(hiding_pillar<Double>(readings));
    const Reached reached = scan(readings, ends);
    EXPECT_NEAR(ends.interval.theta_low, reached.theta_low, 0.01);
    EXPECT_NEAR(ends.interval.theta_high, reached.theta_high, 1e-9);
    EXPECT_NEAR(ends.interval.magnitude_low, reached.magnitude_low, 0.01);
    EXPECT_NEAR(ends.interval.magnitude_high, reached.magnitude_high, 1e-9);
    EXPECT_NEAR(0, reached.turn_low, 0.02);
    EXPECT_NEAR(ends.turn_high(), reached.turn_high, 0.05);
  }
}

TYPED_TEST(DirectionIntervals, AreTheEstimateWhereTheForceIsDetermined) {
  Random random(73);
  for (int i = 0; i < 10'000; ++i) {
    const auto readings = rounded_readings<TypeParam>(random.force(1), kCountsOfOneNewton);
    if (count_positive(readings) < 3) continue;
    const auto pillar = pillar_of<TypeParam>(readings);
    const Ends<TypeParam> ends(pillar);
    const auto direction = direction_of(solve<TypeParam>(pillar, kCountsOfOneNewton).force);
    EXPECT_NEAR(ends.interval.theta_low, direction.theta, ends.slack);
    EXPECT_NEAR(ends.interval.theta_high, direction.theta, ends.slack);
    EXPECT_NEAR(ends.interval.magnitude_low, direction.magnitude, ends.slack);
    EXPECT_NEAR(ends.interval.magnitude_high, direction.magnitude, ends.slack);
    EXPECT_EQ(ends.interval.phi_low, ends.interval.phi_high);
  }
}

/// Readings of 30 counts and more are saturated. Where the other sensels do not bound a component,
/// it is open, and so is the direction; parity recovers one saturated sensel beside three.
TYPED_TEST(DirectionIntervals, AndDeviationsOfSaturatedPillarsHoldTheTruth) {
  using Real = RealOf<TypeParam>;
  Random random(76);
  int finite = 0;
  int open = 0;
  for (int i = 0; i < 20'000; ++i) {
    const ConsistentForce truth = random_truth(random);
    FourReadings<TypeParam> read;
    States states{};
    for (std::size_t n = 0; n < 4; ++n) {
      const double reading = truth.readings()[n];
      read[n] = static_cast<Real>(std::min(reading, 30.0));
      states[n] =
          reading >= 30 ? State::saturated : (reading > 0 ? State::usable : State::inactive);
    }
    if (!has_saturated(states)) continue;
    const auto pillar = pillar_in<TypeParam>(states, read);
    const auto solved = solve<TypeParam>(pillar, kCountsOfOneNewton);
    const auto stated = components(
        open_deviations(force_deviations(pillar, solved.diagonals, solved.sum, {0, 0, 0, 0},
                                         static_cast<Real>(kSegmentPoint), solved.scale),
                        open_components(pillar, solved.diagonals, solved.sum), solved.scale));
    const auto found = components(solved.force);
    const double per_shear = 1 / (2 * std::numbers::sqrt2 * kCountsOfOneNewton);
    const Components force = {(truth.rising - truth.falling) * per_shear,
                              (truth.rising + truth.falling) * per_shear,
                              truth.sum / (2 * kCountsOfOneNewton)};
    const Ends<TypeParam> ends(pillar);
    for (std::size_t part = 0; part < 3; ++part) {
      EXPECT_LE(std::abs(found[part] - force[part]), 1.96 * stated[part] + 1e-5 * truth.magnitude())
          << name_of(states) << ", part " << part;
      ++(stated[part] < kOpenN ? finite : open);
    }
    if (std::ranges::count(states, State::usable) == 3) {
      EXPECT_LT(stated[0] + stated[1] + stated[2], kOpenN);
    } else {
      TestFixture::expect_holds(ends, truth);
    }
  }
  EXPECT_GT(finite, 1000);
  EXPECT_GT(open, 1000);
}

TYPED_TEST(DirectionIntervals, AreFiniteForAllFiniteReadings) {
  using Real = RealOf<TypeParam>;
  const std::array<Real, 6> odd = {std::numeric_limits<Real>::denorm_min(),
                                   static_cast<Real>(1e-30),
                                   1,
                                   100,
                                   static_cast<Real>(1e30),
                                   static_cast<Real>(1e33)};
  Random random(74);
  for (const States& states : all_states()) {
    for (int i = 0; i < 50; ++i) {
      FourReadings<TypeParam> readings;
      for (auto& reading : readings) reading = odd[random.below(odd.size())];
      const auto pillar = pillar_in<TypeParam>(states, readings);
      const auto solved = solve<TypeParam>(pillar, kCountsOfOneNewton);
      const auto open = open_components(pillar, solved.diagonals, solved.sum);
      const auto interval =
          open_interval(direction_interval(pillar, solved.diagonals, solved.sum,
                                           direction_of(solved.force), solved.scale, {1, 1, true}),
                        open);
      const Real most = static_cast<Real>(1e6);
      const auto deviations = open_deviations(
          force_deviations(pillar, solved.diagonals, solved.sum, {most, most, most, most},
                           static_cast<Real>(kSegmentPoint), solved.scale),
          open, solved.scale);
      for (const Real value : {interval.theta_low, interval.theta_high, interval.phi_low,
                               interval.phi_high, interval.magnitude_low, interval.magnitude_high,
                               deviations.shear_x, deviations.shear_y, deviations.normal}) {
        ASSERT_TRUE(std::isfinite(value) || (has_saturated(states) && value > 0))
            << name_of(states);
      }
      ASSERT_LE(interval.theta_low, interval.theta_high + 1e-6F) << name_of(states);
    }
  }
}

}  // namespace
}  // namespace pillarfield
