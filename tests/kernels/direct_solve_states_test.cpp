// Every combination of usable, inactive, missing and saturated sensels has a force and a status,
// and the force is consistent with the readings.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pillarfield/status.h"
#include "pillars.h"

namespace pillarfield {
namespace {

using enum State;

struct Pattern {
  const char* name;
  std::array<int, 4> pressed;  ///< sensels 1 to 4
  int flags;                   ///< expected beside the usable bits
};

constexpr std::array<Pattern, 16> kPatterns = {{
    {"no contact", {0, 0, 0, 0}, 0},
    {"region 4, sensel 1", {1, 0, 0, 0}, 0},
    {"region 4, sensel 2", {0, 1, 0, 0}, 0},
    {"region 3, upper two", {1, 1, 0, 0}, status::kAmbiguous},
    {"region 4, sensel 3", {0, 0, 1, 0}, 0},
    {"opposite, rising", {1, 0, 1, 0}, status::kInconsistent},
    {"region 3, left two", {0, 1, 1, 0}, status::kAmbiguous},
    {"region 2, sensel 4 inactive", {1, 1, 1, 0}, 0},
    {"region 4, sensel 4", {0, 0, 0, 1}, 0},
    {"region 3, right two", {1, 0, 0, 1}, status::kAmbiguous},
    {"opposite, falling", {0, 1, 0, 1}, status::kInconsistent},
    {"region 2, sensel 3 inactive", {1, 1, 0, 1}, 0},
    {"region 3, lower two", {0, 0, 1, 1}, status::kAmbiguous},
    {"region 2, sensel 2 inactive", {1, 0, 1, 1}, 0},
    {"region 2, sensel 1 inactive", {0, 1, 1, 1}, 0},
    {"region 1", {1, 1, 1, 1}, 0},
}};

template <class Precision>
class DirectSolveStates : public testing::Test {
 protected:
  static constexpr double kCountsPerNewton = 50;

  static bool is_zero(const ForceOf<Precision>& force) {
    return force.shear_x == 0 && force.shear_y == 0 && force.normal == 0;
  }

  /// States that a pillar with these readings can have: inactive sensels where they are not
  /// positive.
  static bool fit(const States& states, const FourReadings<Precision>& readings) {
    for (std::size_t n = 0; n < 4; ++n) {
      if (states[n] != missing && (states[n] == inactive) != (readings[n] <= 0)) return false;
    }
    return true;
  }

  /// Saturated sensels read a fraction of their true reading.
  static FourReadings<Precision> clipped(Random& random, const States& states,
                                         FourReadings<Precision> readings) {
    for (std::size_t n = 0; n < 4; ++n) {
      if (states[n] == saturated)
        readings[n] *= static_cast<RealOf<Precision>>(random.uniform(0.1, 0.95));
    }
    return readings;
  }

  /// True if sensels in these states would show the readings of `force`.
  static void expect_consistent(const ForceOf<Precision>& force, const States& states,
                                const FourReadings<Precision>& readings) {
    const oracle::Readings implied = oracle::readings_of(to_exact(force), kCountsPerNewton);
    RealOf<Precision> largest = 0;
    for (std::size_t n = 0; n < 4; ++n) {
      largest = std::max({largest, readings[n], static_cast<RealOf<Precision>>(implied[n])});
    }
    const double rounding = 16 * ulp_at<RealOf<Precision>>(largest);
    for (std::size_t n = 0; n < 4; ++n) {
      SCOPED_TRACE("sensel " + std::to_string(n + 1));
      const auto implies = static_cast<double>(implied[n]);
      switch (states[n]) {
        case usable:
          EXPECT_NEAR(implies, readings[n], rounding);
          break;
        case inactive:
          EXPECT_LE(implies, rounding);
          break;
        case saturated:
          EXPECT_GE(implies, readings[n] - rounding);
          break;
        case missing:
          break;
      }
    }
  }
};
TYPED_TEST_SUITE(DirectSolveStates, Precisions, PrecisionNames);

TYPED_TEST(DirectSolveStates, SixteenPatternsHaveTheirStatus) {
  using Real = RealOf<TypeParam>;
  Random random(61);
  for (std::size_t bits = 0; bits < kPatterns.size(); ++bits) {
    const Pattern& pattern = kPatterns[bits];
    SCOPED_TRACE(pattern.name);
    for (int i = 0; i < 100; ++i) {
      FourReadings<TypeParam> readings;
      for (std::size_t n = 0; n < 4; ++n) {
        readings[n] = static_cast<Real>(pattern.pressed[n] * random.decades(0.1, 100));
      }
      const auto solved = solve<TypeParam>(pillar_of<TypeParam>(readings), 50);
      EXPECT_EQ(solved.status, static_cast<int>(bits) | pattern.flags);
      EXPECT_GE(solved.force.normal, 0);
      EXPECT_EQ(TestFixture::is_zero(solved.force), bits == 0);
    }
  }
}

TYPED_TEST(DirectSolveStates, OneSenselAloneIsShearAlongItsDiagonal) {
  using Force = ForceOf<TypeParam>;
  using Real = RealOf<TypeParam>;
  const double diagonal = 100.0 / 50 / std::numbers::sqrt2;
  const std::array<std::array<int, 2>, 4> signs = {{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  for (std::size_t n = 0; n < 4; ++n) {
    FourReadings<TypeParam> readings{};
    readings[n] = 100;
    const Force force = solve<TypeParam>(pillar_of<TypeParam>(readings), 50).force;
    EXPECT_EQ(force.normal, 0);
    EXPECT_NEAR(force.shear_x, signs[n][0] * diagonal, 1e-6);
    EXPECT_NEAR(force.shear_y, signs[n][1] * diagonal, 1e-6);
    EXPECT_EQ(direction_of(force).theta, std::numbers::pi_v<Real> / 2);
  }
}

/// The status bits of a pillar in these states, without the ambiguous bit.
int expected_status(const States& states) {
  static constexpr States kRisingAlone = {usable, inactive, usable, inactive};
  static constexpr States kFallingAlone = {inactive, usable, inactive, usable};
  int bits = 0;
  for (std::size_t n = 0; n < 4; ++n) {
    if (states[n] == usable) bits |= 1 << n;
    if (states[n] == saturated) bits |= status::kSaturated;
    if (states[n] == missing) bits |= status::kInconsistent;
  }
  if (states == kRisingAlone || states == kFallingAlone) bits |= status::kInconsistent;
  return bits;
}

TYPED_TEST(DirectSolveStates, EveryCombinationIsFiniteAndHasItsBits) {
  using Real = RealOf<TypeParam>;
  Random random(62);
  for (const States& states : all_states()) {
    SCOPED_TRACE(name_of(states));
    const int expected = expected_status(states);
    const bool contact = (expected & (status::kUsable | status::kSaturated)) != 0;
    for (int i = 0; i < 100; ++i) {
      FourReadings<TypeParam> readings;
      for (Real& reading : readings) reading = static_cast<Real>(random.decades(1e-6, 1e6));
      const auto solved = solve<TypeParam>(pillar_in<TypeParam>(states, readings), 50);
      EXPECT_TRUE(std::isfinite(solved.force.shear_x + solved.force.shear_y));
      EXPECT_TRUE(std::isfinite(solved.force.normal));
      EXPECT_GE(solved.force.normal, 0);
      EXPECT_LE(solved.sum.low, solved.sum.high);
      const bool ambiguous = solved.sum.low < solved.sum.high;
      EXPECT_EQ(solved.status, expected | (ambiguous ? status::kAmbiguous : 0));
      EXPECT_EQ(TestFixture::is_zero(solved.force), !contact);
    }
  }
}

TYPED_TEST(DirectSolveStates, EveryForceIsConsistent) {
  Random random(63);
  const std::array<States, 256> all = all_states();
  std::array<int, 256> seen{};
  for (int i = 0; i < 2'000; ++i) {
    const auto truth = random.force(random.decades(0.1, 10));
    const auto readings = rounded_readings<TypeParam>(truth, TestFixture::kCountsPerNewton);
    for (std::size_t c = 0; c < seen.size(); ++c) {
      const States& states = all[c];
      if (!TestFixture::fit(states, readings)) continue;
      SCOPED_TRACE(name_of(states));
      ++seen[c];
      const auto shown = TestFixture::clipped(random, states, readings);
      const auto solved =
          solve<TypeParam>(pillar_in<TypeParam>(states, shown), TestFixture::kCountsPerNewton);
      TestFixture::expect_consistent(solved.force, states, shown);
    }
  }
  // A diagonal that is inactive at both ends has no parity sum above zero: no force has that.
  for (std::size_t c = 0; c < seen.size(); ++c) {
    const States& states = all[c];
    const bool impossible = (states[0] == inactive && states[2] == inactive) ||
                            (states[1] == inactive && states[3] == inactive);
    EXPECT_EQ(seen[c] == 0, impossible) << name_of(states);
  }
}

TYPED_TEST(DirectSolveStates, ABoundedParitySumHoldsTheTruth) {
  const auto bounded = [](const States& states) {
    const auto is_bounded = [&](std::size_t n) {
      return states[n] == usable || states[n] == inactive;
    };
    const bool measured = std::ranges::count(states, saturated) == 0;
    return measured && ((is_bounded(0) && is_bounded(2)) || (is_bounded(1) && is_bounded(3)));
  };
  Random random(65);
  for (const States& states : all_states()) {
    if (!bounded(states)) continue;
    SCOPED_TRACE(name_of(states));
    for (int i = 0; i < 300; ++i) {
      const double k = TestFixture::kCountsPerNewton;
      const auto truth = random.force(1);
      const auto readings = rounded_readings<TypeParam>(truth, k);
      if (!TestFixture::fit(states, readings)) continue;
      const auto sum = solve<TypeParam>(pillar_in<TypeParam>(states, readings), k).sum;
      const double rounding = 4 * ulp_at<RealOf<TypeParam>>(2 * k);
      EXPECT_GE(2 * k * truth.normal, sum.low - rounding);
      EXPECT_LE(2 * k * truth.normal, sum.high + rounding);
    }
  }
}

TYPED_TEST(DirectSolveStates, ThreeUsableReadingsRecoverAnyFourth) {
  Random random(64);
  double worst = 0;
  for (int i = 0; i < 50'000; ++i) {
    const auto readings = rounded_readings<TypeParam>(random.force(random.decades(1e-3, 1e3)),
                                                      TestFixture::kCountsPerNewton);
    if (count_positive(readings) < 4) continue;
    for (std::size_t n = 0; n < 4; ++n) {
      for (const State state : {missing, saturated}) {
        States states = {usable, usable, usable, usable};
        states[n] = state;
        const auto pillar =
            pillar_in<TypeParam>(states, TestFixture::clipped(random, states, readings));
        const oracle::Force expected =
            oracle::least_squares(usable_readings(pillar), TestFixture::kCountsPerNewton);
        const auto solved = solve<TypeParam>(pillar, TestFixture::kCountsPerNewton);
        EXPECT_EQ(solved.status & status::kAmbiguous, 0);
        worst = std::max(worst, force_ulps<TypeParam>(solved.force, expected));
      }
    }
  }
  std::printf("one sensel recovered: worst error %.3f ULP of the magnitude\n", worst);
  EXPECT_LE(worst, 4);
}

/// Every pattern of sensels that the sensor does not have: no fault unless the pillar is in
/// contact, and otherwise the force and status of missing sensels.
TYPED_TEST(DirectSolveStates, AbsentSenselsAreNoFaultWithoutContact) {
  using Real = RealOf<TypeParam>;
  int contacts = 0;
  for (const States& states : all_states()) {
    if (std::ranges::count(states, missing) == 0) continue;
    SCOPED_TRACE(name_of(states));
    auto pillar = pillar_in<TypeParam>(states, {4, 3, 2, 1});
    const auto missed = solve<TypeParam>(pillar, 50);
    const bool contact = (missed.status & (status::kUsable | status::kSaturated)) != 0;
    for (auto* sensel : {&pillar.s1, &pillar.s2, &pillar.s3, &pillar.s4}) {
      if (sensel->missing) *sensel = classify(apply_mask(*sensel, Real{2}), Real{0});
    }
    const auto solved = solve<TypeParam>(pillar, 50);
    EXPECT_EQ(solved.status, contact ? missed.status : 0);
    EXPECT_EQ(solved.force.normal, missed.force.normal);
    contacts += contact ? 1 : 0;
  }
  EXPECT_GT(contacts, 100);
}

TYPED_TEST(DirectSolveStates, SaturatedSenselsNeverReadLessThanFullScale) {
  const auto at = [](const States& states, const FourReadings<TypeParam>& readings) {
    return solve<TypeParam>(pillar_in<TypeParam>(states, readings), 1).sum;
  };
  // A lone diagonal at full scale: the sum is at least its two readings.
  EXPECT_EQ(at({saturated, inactive, usable, inactive}, {255, 0, 40, 0}).low, 295);
  // Two on one side: the diagonal with more decides, and leaves more for the other.
  EXPECT_EQ(at({saturated, usable, usable, saturated}, {255, 140, 100, 255}).low, 395);
  // A saturated reading that equals what parity leaves changes nothing.
  EXPECT_EQ(at({saturated, usable, usable, usable}, {255, 150, 45, 150}).low, 300);
}

TYPED_TEST(DirectSolveStates, NothingBoundsTheSmallestForce) {
  using Force = ForceOf<TypeParam>;
  const auto norm = [](const Force& force) {
    return std::hypot(static_cast<double>(force.shear_x), static_cast<double>(force.shear_y),
                      static_cast<double>(force.normal));
  };
  for (const States& states :
       {States{usable, usable, missing, missing}, States{usable, inactive, missing, missing},
        States{missing, missing, usable, missing}}) {
    SCOPED_TRACE(name_of(states));
    const auto solved = solve<TypeParam>(pillar_in<TypeParam>(states, {90, 60, 30, 10}), 1);
    EXPECT_NE(solved.status & status::kAmbiguous, 0);
    for (const double factor : {0.0, 0.9, 0.99, 1.01, 1.1, 2.0}) {
      const double sum = factor * (solved.sum.low + solved.sum.high) / 2;
      const auto other =
          force_at(solved.diagonals, static_cast<RealOf<TypeParam>>(sum), solved.scale);
      EXPECT_LT(norm(solved.force), norm(other)) << "at " << factor << " of the sum";
    }
  }
}

TYPED_TEST(DirectSolveStates, UnequalDeadZonesAloneAreNoContact) {
  using Real = RealOf<TypeParam>;
  const auto unloaded = [](Real dead_zone) {
    return fill_dead_zone(sensel_in<TypeParam>(inactive, 0), dead_zone);
  };
  const auto gone = sensel_in<TypeParam>(missing, 9);
  for (const auto& pillar :
       {PillarOf<TypeParam>{unloaded(1), unloaded(2), unloaded(3), unloaded(4)},
        PillarOf<TypeParam>{unloaded(1), unloaded(2), gone, gone}}) {
    const auto solved = solve<TypeParam>(pillar, 50);
    EXPECT_TRUE(TestFixture::is_zero(solved.force));
    EXPECT_EQ(solved.status & (status::kAmbiguous | status::kUsable), 0);
  }
}

}  // namespace
}  // namespace pillarfield
