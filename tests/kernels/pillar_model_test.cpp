// The forward model against equation (2) as printed in the paper.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "pillars.h"

namespace pillarfield {
namespace {

template <class Precision>
class PillarModel : public testing::Test {
 protected:
  static std::array<RealOf<Precision>, 4> readings_at(const ForceOf<Precision>& force,
                                                      RealOf<Precision> k) {
    const auto readings = model_readings(force, k);
    return {readings.v1, readings.v2, readings.v3, readings.v4};
  }

  static ForceOf<Precision> random_force(Random& random) {
    const auto force = random.force(random.decades(1e-9, 1e9));
    return {static_cast<RealOf<Precision>>(force.shear_x),
            static_cast<RealOf<Precision>>(force.shear_y),
            static_cast<RealOf<Precision>>(force.normal)};
  }
};
TYPED_TEST_SUITE(PillarModel, Precisions, PrecisionNames);

TYPED_TEST(PillarModel, IsWithinFiveUlpOfTheLargestReading) {
  using Real = RealOf<TypeParam>;
  Random random(1);
  double worst = 0;
  for (int i = 0; i < 200'000; ++i) {
    const auto force = TestFixture::random_force(random);
    const auto k = static_cast<Real>(random.decades(1e-2, 1e6));
    const auto actual = TestFixture::readings_at(force, k);
    const oracle::Readings expected = oracle::readings_of(to_exact(force), k);
    const oracle::Exact largest = *std::ranges::max_element(expected);
    for (std::size_t n = 0; n < 4; ++n) {
      worst = std::max(worst, ulps<Real>(actual[n], expected[n], largest));
    }
  }
  TestFixture::RecordProperty("worst_ulp", std::to_string(worst));
  std::printf("worst error: %.3f ULP of the largest reading\n", worst);
  EXPECT_LE(worst, 5);
}

TYPED_TEST(PillarModel, FollowsThetaAndPhiOfThePaper) {
  using Real = RealOf<TypeParam>;
  for (int theta = 0; theta <= 90; theta += 5) {
    for (int phi = -180; phi <= 180; phi += 5) {
      const oracle::Exact degree = exact::pi() / 180;
      const oracle::Force force = oracle::force_from(3, theta * degree, phi * degree);
      const auto actual = TestFixture::readings_at(
          {static_cast<Real>(force.shear_x), static_cast<Real>(force.shear_y),
           static_cast<Real>(force.normal)},
          Real{20});
      const oracle::Readings expected =
          oracle::readings_from(3, theta * degree, phi * degree, Real{20});
      for (std::size_t n = 0; n < 4; ++n) {
        EXPECT_LE(ulps<Real>(actual[n], expected[n], 60 * exact::sqrt(2)), 5)
            << "theta " << theta << ", phi " << phi << ", sensel " << n + 1;
      }
    }
  }
}

}  // namespace
}  // namespace pillarfield
