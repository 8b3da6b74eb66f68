// Regions 1 and 2 against least squares in 113 bits: at most 4 ULP of the magnitude.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "pillars.h"

namespace pillarfield {
namespace {

constexpr int kCases = 350'000;
constexpr double kBoundUlp = 4;

template <class Precision>
class DirectSolveAccuracy : public testing::Test {
 protected:
  /// The worst error over random pillars that `draw_readings(random, k)` makes.
  template <class Draw>
  static double worst_ulp(std::uint64_t seed, int cases, Draw draw_readings) {
    Random random(seed);
    double worst = 0;
    while (cases > 0) {
      const auto k = static_cast<RealOf<Precision>>(random.decades(1e-2, 1e6));
      const FourReadings<Precision> readings = draw_readings(random, k);
      if (count_positive(readings) < 3) continue;
      const auto pillar = pillar_of<Precision>(readings);
      const oracle::Force expected = oracle::least_squares(usable_readings(pillar), k);
      worst = std::max(worst, force_ulps<Precision>(solve<Precision>(pillar, k).force, expected));
      --cases;
    }
    return worst;
  }

  static void report(const char* kind, double worst) {
    testing::Test::RecordProperty("worst_ulp", std::to_string(worst));
    std::printf("%s: worst error %.3f ULP of the magnitude\n", kind, worst);
    EXPECT_LE(worst, kBoundUlp);
  }

  static FourReadings<Precision> consistent(Random& random, double k) {
    return rounded_readings<Precision>(random.force(random.decades(1e-12, 1e12)), k);
  }
};
TYPED_TEST_SUITE(DirectSolveAccuracy, Precisions, PrecisionNames);

TYPED_TEST(DirectSolveAccuracy, OfConsistentReadings) {
  const double worst = TestFixture::worst_ulp(
      31, kCases, [](Random& random, double k) { return TestFixture::consistent(random, k); });
  TestFixture::report("consistent readings", worst);
}

TYPED_TEST(DirectSolveAccuracy, OfNoisyReadings) {
  using Real = RealOf<TypeParam>;
  const double worst = TestFixture::worst_ulp(32, kCases, [](Random& random, double k) {
    auto readings = TestFixture::consistent(random, k);
    for (Real& reading : readings) reading *= static_cast<Real>(1 + 0.1 * random.normal());
    return readings;
  });
  TestFixture::report("readings with 10 % of noise", worst);
}

TYPED_TEST(DirectSolveAccuracy, OfUnrelatedReadings) {
  using Real = RealOf<TypeParam>;
  const double worst = TestFixture::worst_ulp(33, kCases, [](Random& random, double) {
    FourReadings<TypeParam> readings;
    for (Real& reading : readings) reading = static_cast<Real>(random.decades(1e-3, 1e3));
    readings[random.below(4)] *= static_cast<Real>(random.below(2));
    return readings;
  });
  TestFixture::report("unrelated readings over six decades", worst);
}

TYPED_TEST(DirectSolveAccuracy, OfWholeCounts) {
  using Real = RealOf<TypeParam>;
  const double worst = TestFixture::worst_ulp(34, kCases / 7, [](Random& random, double) {
    FourReadings<TypeParam> readings;
    for (Real& reading : readings) reading = static_cast<Real>(random.below(256));
    return readings;
  });
  TestFixture::report("whole counts up to 255", worst);
}

TYPED_TEST(DirectSolveAccuracy, WhereItsBoundIsLargest) {
  // The direction that the proof finds, and a magnitude whose ULP is smallest beside it.
  const double worst = TestFixture::worst_ulp(35, kCases / 3, [](Random& random, double k) {
    const double magnitude = 1.99 * std::exp2(static_cast<double>(random.below(20)));
    const auto nearly = [&](double share) { return magnitude * (share + random.uniform(0, 1e-3)); };
    return rounded_readings<TypeParam>({nearly(0.861), nearly(-0.199), nearly(0.468)}, k);
  });
  TestFixture::report("in the worst direction", worst);
}

TYPED_TEST(DirectSolveAccuracy, ForwardThenSolveIsTheIdentity) {
  using Real = RealOf<TypeParam>;
  using Force = ForceOf<TypeParam>;
  Random random(35);
  double worst = 0;
  for (int i = 0; i < 100'000; ++i) {
    const auto drawn = random.force(random.decades(1e-9, 1e9));
    const Force force = {static_cast<Real>(drawn.shear_x), static_cast<Real>(drawn.shear_y),
                         static_cast<Real>(drawn.normal)};
    const auto readings = model_readings(force, Real{320});
    const FourReadings<TypeParam> four = {readings.v1, readings.v2, readings.v3, readings.v4};
    if (count_positive(four) < 3) continue;
    const auto solved = solve<TypeParam>(pillar_of<TypeParam>(four), 320);
    worst = std::max(worst, force_ulps<TypeParam>(solved.force, to_exact(force)));
  }
  std::printf("forward, then solve: worst difference %.3f ULP of the magnitude\n", worst);
  // The model's 5 ULP of the largest reading, through a solve that sums four, and the solve's 4.
  EXPECT_LE(worst, 16);
}

TYPED_TEST(DirectSolveAccuracy, NoiseSpreadsAsLeastSquaresSays) {
  using Real = RealOf<TypeParam>;
  constexpr int kDraws = 40'000;
  Random random(36);
  double in_four = 0;
  double in_three = 0;
  for (int i = 0; i < kDraws; ++i) {
    FourReadings<TypeParam> readings;
    for (Real& reading : readings) reading = static_cast<Real>(100 + random.normal());
    const auto squared_error = [](const auto& force) {
      return force.shear_x * force.shear_x + force.shear_y * force.shear_y +
             (force.normal - 100) * (force.normal - 100);
    };
    in_four += squared_error(solve<TypeParam>(pillar_of<TypeParam>(readings), 1).force) / kDraws;
    readings[random.below(4)] = 0;
    in_three += squared_error(solve<TypeParam>(pillar_of<TypeParam>(readings), 1).force) / kDraws;
  }
  EXPECT_NEAR(in_four, 1.25, 0.03);
  EXPECT_NEAR(in_three, 2.5, 0.06);
}

TYPED_TEST(DirectSolveAccuracy, NothingOverflowsWithinTheLimits) {
  using Real = RealOf<TypeParam>;
  using Limits = std::numeric_limits<Real>;
  // kMaxCounts of reading and of tare, kMaxGain, kMaxCounts of dead zone; kMinCountsPerNewton.
  const Real largest = static_cast<Real>((1e33 + 1e33) * 1e2 + 1e33);
  Random random(37);
  for (const States& states : all_states()) {
    for (int i = 0; i < 50; ++i) {
      FourReadings<TypeParam> readings;
      for (Real& reading : readings) {
        reading = random.below(2) == 0 ? largest : Limits::denorm_min();
      }
      const auto solved = solve<TypeParam>(pillar_in<TypeParam>(states, readings), 1e-2);
      for (const auto& force : {solved.force, solved.low(), solved.high()}) {
        EXPECT_TRUE(std::isfinite(force.shear_x + force.shear_y + force.normal)) << name_of(states);
      }
    }
  }
}

TYPED_TEST(DirectSolveAccuracy, SubnormalReadingsLoseOnlySubnormals) {
  using Real = RealOf<TypeParam>;
  using Limits = std::numeric_limits<Real>;
  Random random(38);
  for (int i = 0; i < 1000; ++i) {
    FourReadings<TypeParam> readings;
    for (Real& reading : readings) {
      reading = static_cast<Real>(1 + random.below(100)) * Limits::denorm_min();
    }
    const auto pillar = pillar_of<TypeParam>(readings);
    const oracle::Force expected = oracle::least_squares(usable_readings(pillar), 1);
    const auto force = solve<TypeParam>(pillar, 1).force;
    EXPECT_LE(ulps<Real>(force.shear_x, expected.shear_x, 0), 2);
    EXPECT_LE(ulps<Real>(force.shear_y, expected.shear_y, 0), 2);
    EXPECT_LE(ulps<Real>(force.normal, expected.normal, 0), 2);
  }
}

}  // namespace
}  // namespace pillarfield
