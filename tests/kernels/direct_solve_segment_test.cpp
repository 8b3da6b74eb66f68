// Region 3: the readings leave a segment of forces, of which the solve reports the segment point.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "pillarfield/status.h"
#include "pillars.h"

namespace pillarfield {
namespace {

template <class Force>
double distance(const Force& a, const Force& b) {
  return std::hypot(static_cast<double>(a.shear_x) - b.shear_x,
                    static_cast<double>(a.shear_y) - b.shear_y,
                    static_cast<double>(a.normal) - b.normal);
}

template <class Precision>
class DirectSolveSegment : public testing::Test {
 protected:
  /// Calls `check(truth, readings)` for random forces under which two adjacent sensels are
  /// inactive.
  template <class Check>
  static void for_random_region_three(int cases, Check check) {
    Random random(51);
    while (cases > 0) {
      const auto truth = random.force(random.decades(1e-6, 1e6));
      const auto readings = rounded_readings<Precision>(truth, kCountsPerNewton);
      if (count_positive(readings) != 2) continue;
      check(truth, readings);
      --cases;
    }
  }

  /// The ULP of RealOf<Precision> that a force of this size has.
  static double ulp_of(const double_precision::Force& force) {
    return ulp_at<RealOf<Precision>>(std::hypot(force.shear_x, force.shear_y, force.normal));
  }

  static constexpr double kCountsPerNewton = 320;
};
TYPED_TEST_SUITE(DirectSolveSegment, Precisions, PrecisionNames);

TYPED_TEST(DirectSolveSegment, HasTheEndsThatBisectionFinds) {
  double worst = 0;
  TestFixture::for_random_region_three(1000, [&](const auto&, const auto& readings) {
    const auto pillar = pillar_of<TypeParam>(readings);
    const auto solved = solve<TypeParam>(pillar, TestFixture::kCountsPerNewton);
    const oracle::Segment expected =
        oracle::segment_of(usable_readings(pillar), TestFixture::kCountsPerNewton);
    worst = std::max(worst, force_ulps<TypeParam>(solved.low(), expected.low));
    worst = std::max(worst, force_ulps<TypeParam>(solved.high(), expected.high));
  });
  std::printf("ends of the segment: worst error %.3f ULP of the magnitude\n", worst);
  EXPECT_LE(worst, 4);
}

TYPED_TEST(DirectSolveSegment, HoldsTheTruthAndTheForceAtItsPoint) {
  for (const double part : {0.5, kSegmentPoint, 1.0}) {
    TestFixture::for_random_region_three(30'000, [part](const auto& truth, const auto& readings) {
      const auto solved =
          solve<TypeParam>(pillar_of<TypeParam>(readings), TestFixture::kCountsPerNewton, part);
      const double_precision::Force low = {solved.low().shear_x, solved.low().shear_y,
                                           solved.low().normal};
      const double_precision::Force high = {solved.high().shear_x, solved.high().shear_y,
                                            solved.high().normal};
      const double_precision::Force point = {solved.force.shear_x, solved.force.shear_y,
                                             solved.force.normal};
      const double rounding = 16 * TestFixture::ulp_of(truth);
      const double length = distance(low, high);
      EXPECT_NE(solved.status & status::kAmbiguous, 0);
      // On the segment the distances to its two ends add up to its length.
      EXPECT_NEAR(distance(truth, low) + distance(truth, high), length, rounding);
      EXPECT_NEAR(distance(point, low), part * length, rounding);
      EXPECT_NEAR(distance(point, high), (1 - part) * length, rounding);
      EXPECT_LE(distance(truth, point), std::max(part, 1 - part) * length + rounding);
    });
  }
}

/// The normal force of a pillar with counts_per_newton 1/2: equal to its parity sum.
template <class Precision>
double sum_of(const PillarOf<Precision>& pillar, double segment_point) {
  return static_cast<double>(solve<Precision>(pillar, 0.5, segment_point).force.normal);
}

TYPED_TEST(DirectSolveSegment,
           HasItsPointWhereASenselOfEachDiagonalIsMeasuredAndTheMidpointElsewhere) {
  using Real = RealOf<TypeParam>;
  const auto usable = TypeParam::raw_sensel(40);
  const auto inactive = TypeParam::raw_sensel(0);
  const auto missing = apply_mask(TypeParam::raw_sensel(40), Real{0});
  const auto saturated = mark_saturated(TypeParam::raw_sensel(60), Real{60});
  const auto at = [&](auto one, auto two, auto three, auto four, double segment_point) {
    const Real threshold = 4;
    const PillarOf<TypeParam> pillar = {classify(one, threshold), classify(two, threshold),
                                        classify(three, threshold), classify(four, threshold)};
    return sum_of<TypeParam>(pillar, segment_point);
  };
  for (const double part : {0.25, 0.5, 0.875, 1.0}) {
    EXPECT_EQ(at(usable, usable, inactive, inactive, part), part * 44);
    EXPECT_EQ(at(saturated, saturated, inactive, inactive, part), part * 64);
    EXPECT_EQ(at(usable, saturated, inactive, inactive, part), part * 44);
    // One sensel is missing: the other diagonal bounds the sum.
    EXPECT_EQ(at(usable, usable, missing, inactive, part), part * 44);
    EXPECT_EQ(at(usable, inactive, inactive, missing, part), part * 44);
    // Thresholds or the smallest force set the upper end.
    EXPECT_EQ(at(usable, inactive, inactive, inactive, part), 4);
    EXPECT_EQ(at(usable, inactive, missing, inactive, part), 4);
    EXPECT_NEAR(at(usable, usable, missing, missing, part), 160 / 3.0, 1e-4);
    // The force is determined.
    EXPECT_EQ(at(usable, usable, usable, inactive, part), 80);
    EXPECT_EQ(at(usable, inactive, usable, inactive, part), 80);
    EXPECT_EQ(at(inactive, inactive, inactive, inactive, part), 0);
  }
}

TYPED_TEST(DirectSolveSegment, IsConsistentWithTheReadings) {
  using Real = RealOf<TypeParam>;
  TestFixture::for_random_region_three(2'000, [](const auto&, const auto& readings) {
    const auto solved =
        solve<TypeParam>(pillar_of<TypeParam>(readings), TestFixture::kCountsPerNewton);
    const Real largest = *std::ranges::max_element(readings);
    for (const double share : {0.0, 0.2, 0.5, 0.9, 1.0}) {
      const auto force =
          force_at(solved.diagonals, static_cast<Real>(share * solved.sum.high), solved.scale);
      const oracle::Readings implied =
          oracle::readings_of(to_exact(force), TestFixture::kCountsPerNewton);
      for (std::size_t n = 0; n < 4; ++n) {
        if (readings[n] > 0) {
          EXPECT_LE(ulps<Real>(readings[n], implied[n], largest), 8);
        } else {
          EXPECT_LE(static_cast<double>(implied[n]), 8 * ulp_at<Real>(largest));
        }
      }
    }
  });
}

TYPED_TEST(DirectSolveSegment, HasTheExactShearAlongThePressedSide) {
  TestFixture::for_random_region_three(20'000, [](const auto& truth, const auto& readings) {
    const auto solved =
        solve<TypeParam>(pillar_of<TypeParam>(readings), TestFixture::kCountsPerNewton);
    const double rounding = 8 * TestFixture::ulp_of(truth);
    const bool above_or_below = (readings[0] > 0) == (readings[1] > 0);
    if (above_or_below) {
      EXPECT_NEAR(solved.force.shear_x, truth.shear_x, rounding);
    } else {
      EXPECT_NEAR(solved.force.shear_y, truth.shear_y, rounding);
    }
  });
}

TYPED_TEST(DirectSolveSegment, HoldsTheTruthBehindADeadZone) {
  using Real = RealOf<TypeParam>;
  const Real dead_zone = 20;
  Random random(52);
  int ambiguous = 0;
  for (int i = 0; i < 50'000; ++i) {
    const double k = TestFixture::kCountsPerNewton;
    const auto truth = random.force(random.decades(0.05, 2));
    const auto readings = rounded_readings<TypeParam>(truth, k);
    const auto response = [&](Real reading) {
      return fill_dead_zone(classify(TypeParam::raw_sensel(reading - dead_zone), Real{0}),
                            dead_zone);
    };
    const auto solved = solve<TypeParam>({response(readings[0]), response(readings[1]),
                                          response(readings[2]), response(readings[3])},
                                         k);
    if (!(solved.sum.low < solved.sum.high)) continue;
    EXPECT_NE(solved.status & status::kAmbiguous, 0);
    ++ambiguous;
    const double sum = 2 * k * truth.normal;
    EXPECT_GE(sum, solved.sum.low);
    EXPECT_LE(sum, solved.sum.high + 16 * TestFixture::ulp_of(truth) * k);
  }
  EXPECT_GT(ambiguous, 5'000);
}

}  // namespace
}  // namespace pillarfield
