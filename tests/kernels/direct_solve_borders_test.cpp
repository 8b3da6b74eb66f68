// The force as a reading appears and vanishes: continuous where the model is; elsewhere the force
// before lies on the segment after.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pillars.h"

namespace pillarfield {
namespace {

template <class Precision>
class DirectSolveBorders : public testing::Test {
 protected:
  static ForceOf<Precision> force_of(const FourReadings<Precision>& readings,
                                     RealOf<Precision> threshold = 0) {
    return solve<Precision>(pillar_of<Precision>(readings, threshold), 1).force;
  }

  static double distance(const ForceOf<Precision>& a, const ForceOf<Precision>& b) {
    return std::hypot(static_cast<double>(a.shear_x) - static_cast<double>(b.shear_x),
                      static_cast<double>(a.shear_y) - static_cast<double>(b.shear_y),
                      static_cast<double>(a.normal) - static_cast<double>(b.normal));
  }

  /// `readings`, sensel 1's being the first, turned so that it is sensel `first`.
  static FourReadings<Precision> turned(const FourReadings<Precision>& readings,
                                        std::size_t first) {
    FourReadings<Precision> result;
    for (std::size_t n = 0; n < 4; ++n) result[(n + first) % 4] = readings[n];
    return result;
  }

  static constexpr double kUlp = std::numeric_limits<RealOf<Precision>>::epsilon();
  static constexpr RealOf<Precision> kLeast = std::numeric_limits<RealOf<Precision>>::denorm_min();
};
TYPED_TEST_SUITE(DirectSolveBorders, Precisions, PrecisionNames);

TYPED_TEST(DirectSolveBorders, RegionOneToTwoAtEverySensel) {
  using Real = RealOf<TypeParam>;
  for (std::size_t lifting = 0; lifting < 4; ++lifting) {
    const auto pressed = TestFixture::turned({TestFixture::kLeast, 40, 100, 60}, lifting);
    const auto inactive = TestFixture::turned({0, 40, 100, 60}, lifting);
    const auto pulled = TestFixture::turned({-Real{1}, 40, 100, 60}, lifting);
    EXPECT_LE(
        TestFixture::distance(TestFixture::force_of(pressed), TestFixture::force_of(inactive)),
        1000 * TestFixture::kUlp);
    EXPECT_EQ(TestFixture::distance(TestFixture::force_of(pulled), TestFixture::force_of(inactive)),
              0);
  }
}

TYPED_TEST(DirectSolveBorders, RegionOneToTwoAtAThreshold) {
  using Real = RealOf<TypeParam>;
  const Real threshold = 10;
  for (std::size_t lifting = 0; lifting < 4; ++lifting) {
    const Real above = std::nextafter(threshold, Real{11});
    const auto usable = TestFixture::turned({above, 40, 90, 60}, lifting);
    const auto inactive = TestFixture::turned({threshold, 40, 90, 60}, lifting);
    EXPECT_LE(TestFixture::distance(TestFixture::force_of(usable, threshold),
                                    TestFixture::force_of(inactive, threshold)),
              1000 * TestFixture::kUlp);
  }
}

TYPED_TEST(DirectSolveBorders, RegionTwoMeetsTheEndOfRegionThree) {
  for (std::size_t first = 0; first < 4; ++first) {
    // Sensels 1 and 2 pressed, 4 inactive, 3 about to become inactive.
    const auto in_two = TestFixture::turned({70, 90, TestFixture::kLeast, 0}, first);
    const auto in_three = TestFixture::turned({70, 90, 0, 0}, first);
    const auto segment = solve<TypeParam>(pillar_of<TypeParam>(in_three), 1);
    EXPECT_LE(TestFixture::distance(TestFixture::force_of(in_two), segment.high()),
              1000 * TestFixture::kUlp);
    EXPECT_NEAR(TestFixture::distance(TestFixture::force_of(in_two), segment.force),
                (1 - kSegmentPoint) * TestFixture::distance(segment.low(), segment.high()),
                1000 * TestFixture::kUlp);
  }
}

TYPED_TEST(DirectSolveBorders, RegionThreeShrinksToRegionFour) {
  using Real = RealOf<TypeParam>;
  for (std::size_t first = 0; first < 4; ++first) {
    const auto in_four = TestFixture::force_of(TestFixture::turned({70, 0, 0, 0}, first));
    for (const Real last : {Real{1}, Real{0x1p-10}, Real{0x1p-20}, TestFixture::kLeast}) {
      const auto in_three = TestFixture::force_of(TestFixture::turned({70, last, 0, 0}, first));
      EXPECT_LE(TestFixture::distance(in_three, in_four), 2 * static_cast<double>(last))
          << "with " << last << " counts left";
    }
  }
}

TYPED_TEST(DirectSolveBorders, ContactBeginsAtNothing) {
  using Real = RealOf<TypeParam>;
  for (const Real first : {TestFixture::kLeast, Real{0x1p-20}, Real{1}}) {
    for (std::size_t sensel = 0; sensel < 4; ++sensel) {
      const auto force = TestFixture::force_of(TestFixture::turned({first, 0, 0, 0}, sensel));
      EXPECT_LE(TestFixture::distance(force, {0, 0, 0}), 2 * static_cast<double>(first));
    }
  }
}

TYPED_TEST(DirectSolveBorders, AThresholdStepsByNoMoreThanItself) {
  using Real = RealOf<TypeParam>;
  const Real threshold = 10;
  const Real above = std::nextafter(threshold, Real{11});
  for (std::size_t first = 0; first < 4; ++first) {
    for (const auto& others :
         {FourReadings<TypeParam>{above, 0, 0, 0}, FourReadings<TypeParam>{above, 40, 0, 0},
          FourReadings<TypeParam>{above, 0, 0, 40}}) {
      auto without = others;
      without[0] = threshold;
      EXPECT_LE(TestFixture::distance(
                    TestFixture::force_of(TestFixture::turned(others, first), threshold),
                    TestFixture::force_of(TestFixture::turned(without, first), threshold)),
                2 * static_cast<double>(threshold));
    }
  }
}

TYPED_TEST(DirectSolveBorders, AlongASweepTheForceNeverJumpsInRegionsOneAndTwo) {
  using Real = RealOf<TypeParam>;
  // The direction turns through regions 1 and 2 at 40 degrees from the normal.
  constexpr int kSteps = 3600;
  const oracle::Exact theta = exact::pi() * 40 / 180;
  FourReadings<TypeParam> readings;
  ForceOf<TypeParam> before{};
  for (int step = 0; step <= kSteps; ++step) {
    const oracle::Exact phi = 2 * exact::pi() * step / kSteps - exact::pi();
    const oracle::Readings exact_readings = oracle::readings_from(1, theta, phi, 1);
    for (std::size_t n = 0; n < 4; ++n) readings[n] = static_cast<Real>(exact_readings[n]);
    ASSERT_GE(count_positive(readings), 3);
    const auto force = TestFixture::force_of(readings);
    if (step > 0) {
      EXPECT_NEAR(TestFixture::distance(force, before),
                  2 * M_PI / kSteps * std::sin(40 * M_PI / 180), 1e-6);
    }
    before = force;
  }
}

}  // namespace
}  // namespace pillarfield
