// The stages of one sensel.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "pillars.h"

namespace pillarfield {
namespace {

template <class Precision>
class SenselStages : public testing::Test {
 protected:
  static RealOf<Precision> above(RealOf<Precision> x) {
    return std::nextafter(x, std::numeric_limits<RealOf<Precision>>::infinity());
  }
  static RealOf<Precision> below(RealOf<Precision> x) {
    return std::nextafter(x, -std::numeric_limits<RealOf<Precision>>::infinity());
  }

  static void expect_inactive(const SenselOf<Precision>& sensel, RealOf<Precision> reading = 0) {
    EXPECT_TRUE(is_inactive(sensel));
    EXPECT_EQ(sensel.reading, reading);
  }
  static void expect_missing(const SenselOf<Precision>& sensel) {
    EXPECT_TRUE(sensel.missing);
    EXPECT_FALSE(sensel.usable | sensel.saturated | is_inactive(sensel));
    EXPECT_EQ(sensel.reading, 0);
  }
  static void expect_usable(const SenselOf<Precision>& sensel, RealOf<Precision> reading) {
    EXPECT_TRUE(sensel.usable);
    EXPECT_FALSE(sensel.missing | sensel.saturated | is_inactive(sensel));
    EXPECT_EQ(sensel.reading, reading);
  }
  static void expect_saturated(const SenselOf<Precision>& sensel, RealOf<Precision> reading) {
    EXPECT_TRUE(sensel.saturated);
    EXPECT_FALSE(sensel.missing | sensel.usable | is_inactive(sensel));
    EXPECT_EQ(sensel.reading, reading);
  }
};
TYPED_TEST_SUITE(SenselStages, Precisions, PrecisionNames);

TYPED_TEST(SenselStages, ReadingsOutOfRangeAreMissing) {
  using Real = RealOf<TypeParam>;
  using Limits = std::numeric_limits<Real>;
  const Real largest = static_cast<Real>(1e33);
  const std::vector<Real> absurd = {
      Limits::quiet_NaN(), -Limits::quiet_NaN(), Limits::infinity(),         -Limits::infinity(),
      Limits::max(),       -Limits::max(),       TestFixture::above(largest)};
  for (const Real raw : absurd) {
    TestFixture::expect_missing(
        classify(reject_out_of_range(TypeParam::raw_sensel(raw), largest), Real{0}));
  }
  TestFixture::expect_usable(
      classify(reject_out_of_range(TypeParam::raw_sensel(largest), largest), Real{0}), largest);
  for (const Real raw : {-largest, Real{-1}, Real{0}, -Limits::denorm_min()}) {
    TestFixture::expect_inactive(
        classify(reject_out_of_range(TypeParam::raw_sensel(raw), largest), Real{0}));
  }
}

TYPED_TEST(SenselStages, AThresholdIsNotAboveItselfAndBoundsInactiveSensels) {
  using Real = RealOf<TypeParam>;
  using Limits = std::numeric_limits<Real>;
  for (const Real threshold : {Real{0}, Limits::denorm_min(), Real{3}, Real{250.5}}) {
    TestFixture::expect_inactive(classify(TypeParam::raw_sensel(threshold), threshold), threshold);
    TestFixture::expect_inactive(
        classify(TypeParam::raw_sensel(TestFixture::below(threshold)), threshold), threshold);
    const Real more = TestFixture::above(threshold);
    TestFixture::expect_usable(classify(TypeParam::raw_sensel(more), threshold), more);
  }
}

TYPED_TEST(SenselStages, FullScaleAndMoreIsSaturated) {
  using Real = RealOf<TypeParam>;
  const Real full = 255;
  const auto sensel = [&](Real raw) {
    return classify(mark_saturated(TypeParam::raw_sensel(raw), full), Real{0});
  };
  TestFixture::expect_saturated(sensel(full), full);
  TestFixture::expect_saturated(sensel(TestFixture::above(full)), TestFixture::above(full));
  TestFixture::expect_usable(sensel(TestFixture::below(full)), TestFixture::below(full));
  TestFixture::expect_inactive(sensel(0));
}

TYPED_TEST(SenselStages, APowerLawLinearisesToItsAccuracy) {
  using Real = RealOf<TypeParam>;
  const Real largest = static_cast<Real>(1e33);
  for (const Real exponent : {Real{0.25}, Real{0.75}, Real{1}, Real{1.25}, Real{5}}) {
    for (const Real reading : {Real{0.125}, Real{2.75}, Real{90}, Real{254}, Real{65535}}) {
      const Real reference = 90;
      const auto sensel =
          apply_power_law(TypeParam::raw_sensel(reading), exponent, reference, largest);
      const double expected = 90 * std::pow(double{reading} / 90, double{exponent});
      // The quotient's rounding grows with the exponent; pow and the product add theirs.
      const double epsilon = std::numeric_limits<Real>::epsilon();
      EXPECT_NEAR(sensel.reading, expected, (0.5 * exponent + 3) * epsilon * expected);
    }
  }
}

TEST(PowerLaw, PowersHaveTheStatedError) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> logarithm(-30, 30);
  std::uniform_real_distribution<float> exponents(-4, 4);
  for (int i = 0; i < 100'000; ++i) {
    const auto base = static_cast<float>(std::exp2(logarithm(random)));
    const float exponent = exponents(random);
    const double expected = std::pow(double{base}, double{exponent});
    if (!(expected > 1e-37 && expected < 1e38)) continue;
    EXPECT_NEAR(single_precision::power_of(base, exponent), expected,
                (3 + std::abs(exponent)) * 0x1p-23 * expected)
        << base << " ^ " << exponent;
  }
  EXPECT_EQ(single_precision::power_of(1, 3.7F), 1);
  EXPECT_GE(single_precision::power_of(1e38F, 9), 0x1p126F) << "stays near the largest number";
  EXPECT_LE(single_precision::power_of(1e-37F, 9), 0x1p-125F);
}

TYPED_TEST(SenselStages, SaturationBelowTheThresholdIsMissing) {
  using Real = RealOf<TypeParam>;
  const auto marked = mark_saturated(TypeParam::raw_sensel(10), Real{10});
  TestFixture::expect_missing(classify(subtract_tare(marked, Real{30}), Real{0}));
  TestFixture::expect_missing(classify(marked, Real{10}));
}

TYPED_TEST(SenselStages, ADeadZoneIsAddedAndBoundsInactiveSensels) {
  using Real = RealOf<TypeParam>;
  using Sensel = SenselOf<TypeParam>;
  const auto filled = [](const Sensel& sensel) { return fill_dead_zone(sensel, Real{4}); };
  TestFixture::expect_usable(filled(classify(TypeParam::raw_sensel(3), Real{2})), 7);
  TestFixture::expect_saturated(filled(sensel_in<TypeParam>(State::saturated, 255)), 259);
  TestFixture::expect_inactive(filled(classify(TypeParam::raw_sensel(2), Real{2})), 6);
  TestFixture::expect_missing(filled(sensel_in<TypeParam>(State::missing, 9)));
}

}  // namespace
}  // namespace pillarfield
