// The paper's estimator: exact where the force is determined, the midpoint of the contour in
// region 3.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "pillarfield/status.h"
#include "pillars.h"

namespace pillarfield {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kCountsPerNewton = 50;

template <class Precision>
class PaperSolve : public testing::Test {
 protected:
  static ForceOf<Precision> paper(const PillarOf<Precision>& pillar) {
    const auto solved = solve<Precision>(pillar, kCountsPerNewton);
    return paper_force(pillar, solved.diagonals, solved.sum, solved.scale);
  }
  static ForceOf<Precision> paper(const FourReadings<Precision>& readings) {
    return paper(pillar_of<Precision>(readings));
  }
  static ForceOf<Precision> direct(const PillarOf<Precision>& pillar) {
    return solve<Precision>(pillar, kCountsPerNewton).force;
  }

  /// Distance of two forces as a fraction of the second.
  template <class Actual, class Expected>
  static double error(const Actual& actual, const Expected& expected) {
    const auto of = [](auto x) { return static_cast<double>(x); };
    const double distance = std::hypot(of(actual.shear_x) - of(expected.shear_x),
                                       of(actual.shear_y) - of(expected.shear_y),
                                       of(actual.normal) - of(expected.normal));
    return distance / std::hypot(of(expected.shear_x), of(expected.shear_y), of(expected.normal));
  }

  static constexpr double kEpsilon = std::numeric_limits<RealOf<Precision>>::epsilon();
};
TYPED_TEST_SUITE(PaperSolve, Precisions, PrecisionNames);

TYPED_TEST(PaperSolve, RegionsOneAndTwoGiveTheForceBack) {
  Random random(61);
  std::array<int, kRegions> cases{};
  for (int i = 0; i < 50'000; ++i) {
    const auto force = random.force(random.decades(1e-6, 1e6));
    const auto readings = rounded_readings<TypeParam>(force, kCountsPerNewton);
    const int usable = count_positive(readings);
    if (usable < 3) continue;
    ++cases[static_cast<std::size_t>(usable)];
    EXPECT_LT(TestFixture::error(TestFixture::paper(readings), force), 64 * TestFixture::kEpsilon);
  }
  EXPECT_GT(cases[4], 5'000);
  EXPECT_GT(cases[3], 5'000);
}

TYPED_TEST(PaperSolve, RegionThreeIsHalfWayInThetaOnTheContour) {
  Random random(62);
  int cases = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto truth = random.force(random.decades(1e-3, 1e3));
    const auto readings = rounded_readings<TypeParam>(truth, kCountsPerNewton);
    if (count_positive(readings) != 2) continue;
    ++cases;
    const auto force = TestFixture::paper(readings);
    const auto segment =
        oracle::segment_of(usable_readings(pillar_of<TypeParam>(readings)), kCountsPerNewton);
    const auto theta_of = [](const auto& f) {
      return std::atan2(std::hypot(static_cast<double>(f.shear_x), static_cast<double>(f.shear_y)),
                        static_cast<double>(f.normal));
    };
    const double middle = (theta_of(segment.high) + kPi / 2) / 2;
    EXPECT_NEAR(theta_of(force), middle, 16 * TestFixture::kEpsilon);
    const auto back = oracle::readings_of(to_exact(force), kCountsPerNewton);
    const double largest = *std::ranges::max_element(readings);
    for (std::size_t n = 0; n < 4; ++n) {
      if (readings[n] > 0) {
        EXPECT_NEAR(static_cast<double>(back[n]), static_cast<double>(readings[n]),
                    64 * TestFixture::kEpsilon * largest);
      } else {
        EXPECT_LT(static_cast<double>(back[n]), 64 * TestFixture::kEpsilon * largest);
      }
    }
  }
  EXPECT_GT(cases, 2'000);
}

TYPED_TEST(PaperSolve, RegionFourIsFlatAlongTheDiagonal) {
  for (std::size_t n = 0; n < 4; ++n) {
    FourReadings<TypeParam> readings{};
    readings[n] = 100;
    // The force comes from the side opposite to the pressed sensel, and pushes towards it.
    const double towards = kPi / 4 * (2 * static_cast<double>(n) + 1);
    const double shear = 100 / kCountsPerNewton;
    const oracle::Force expected = {shear * std::cos(towards), shear * std::sin(towards), 0};
    EXPECT_LT(TestFixture::error(TestFixture::paper(readings), expected),
              8 * TestFixture::kEpsilon);
  }
}

TYPED_TEST(PaperSolve, MissingIsUnusableAndSaturatedUsable) {
  const FourReadings<TypeParam> readings = {30, 20, 25, 35};
  for (std::size_t n = 0; n < 4; ++n) {
    States missing = {State::usable, State::usable, State::usable, State::usable};
    missing[n] = State::missing;
    auto without = readings;
    without[n] = 0;
    const auto force = TestFixture::paper(pillar_in<TypeParam>(missing, readings));
    EXPECT_EQ(TestFixture::error(force, TestFixture::paper(without)), 0);
    missing[n] = State::saturated;
    const auto saturated = TestFixture::paper(pillar_in<TypeParam>(missing, readings));
    EXPECT_EQ(TestFixture::error(saturated, TestFixture::paper(readings)), 0);
  }
}

TYPED_TEST(PaperSolve, OppositeSenselsAloneAreSolvedDirectly) {
  using Readings = FourReadings<TypeParam>;
  for (const Readings& readings : {Readings{10, 0, 30, 0}, Readings{0, 7, 0, 5}}) {
    const auto pillar = pillar_of<TypeParam>(readings);
    EXPECT_EQ(TestFixture::error(TestFixture::paper(pillar), TestFixture::direct(pillar)), 0);
  }
  const auto nothing = TestFixture::paper(Readings{0, 0, 0, 0});
  EXPECT_EQ(nothing.shear_x, 0);
  EXPECT_EQ(nothing.shear_y, 0);
  EXPECT_EQ(nothing.normal, 0);
}

}  // namespace
}  // namespace pillarfield
