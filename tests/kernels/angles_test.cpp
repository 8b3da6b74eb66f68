// Magnitude, theta and phi against angles from series.

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "pillars.h"

namespace pillarfield {
namespace {

template <class Precision>
class Angles : public testing::Test {};
TYPED_TEST_SUITE(Angles, Precisions, PrecisionNames);

struct WorstUlps {
  double magnitude = 0;
  double theta = 0;
  double phi = 0;
};

template <class Precision>
void widen(WorstUlps& worst, const ForceOf<Precision>& force) {
  using Real = RealOf<Precision>;
  const auto direction = direction_of(force);
  const oracle::Force exact_force = to_exact(force);
  const oracle::Exact shear = exact::sqrt(exact_force.shear_x * exact_force.shear_x +
                                          exact_force.shear_y * exact_force.shear_y);
  const oracle::Exact magnitude = oracle::magnitude(exact_force);
  const oracle::Exact theta = exact::atan2(shear, exact_force.normal);
  const oracle::Exact phi = exact::atan2(-exact_force.shear_y, -exact_force.shear_x);
  worst.magnitude =
      std::max(worst.magnitude, ulps<Real>(direction.magnitude, magnitude, magnitude));
  worst.theta = std::max(worst.theta, ulps<Real>(direction.theta, theta, theta));
  worst.phi = std::max(worst.phi, ulps<Real>(direction.phi, phi, phi));
}

TYPED_TEST(Angles, AreWithinThreeUlp) {
  using Real = typename TypeParam::Real;
  Random random(11);
  WorstUlps worst;
  for (int i = 0; i < 30'000; ++i) {
    const auto component = [&] {
      const double sign = random.below(2) == 0 ? 1 : -1;
      return static_cast<Real>(sign * random.decades(1e-6, 1e3));
    };
    widen<TypeParam>(worst, {component(), component(), component()});
  }
  TestFixture::RecordProperty("worst_ulp_magnitude", std::to_string(worst.magnitude));
  TestFixture::RecordProperty("worst_ulp_theta", std::to_string(worst.theta));
  TestFixture::RecordProperty("worst_ulp_phi", std::to_string(worst.phi));
  std::printf("worst errors: magnitude %.3f, theta %.3f, phi %.3f ULP\n", worst.magnitude,
              worst.theta, worst.phi);
  EXPECT_LE(worst.magnitude, 2);
  EXPECT_LE(worst.theta, 3);
  EXPECT_LE(worst.phi, 3);
}

TYPED_TEST(Angles, OfNoForceAreZero) {
  using Force = typename TypeParam::Force;
  const auto direction = direction_of(Force{0, 0, 0});
  EXPECT_EQ(direction.magnitude, 0);
  EXPECT_EQ(direction.theta, 0);
  EXPECT_EQ(direction.phi, 0);
}

TYPED_TEST(Angles, OfPressingAloneAreZero) {
  using Force = typename TypeParam::Force;
  using Real = typename TypeParam::Real;
  for (const Real zero : {Real{0}, -Real{0}}) {
    const auto direction = direction_of(Force{zero, zero, 5});
    EXPECT_EQ(direction.magnitude, 5);
    EXPECT_EQ(direction.theta, 0);
    EXPECT_EQ(direction.phi, 0);
  }
}

TYPED_TEST(Angles, OfPullAlonePointInward) {
  using Force = typename TypeParam::Force;
  using Real = typename TypeParam::Real;
  EXPECT_EQ(direction_of(Force{0, 0, -5}).theta, std::numbers::pi_v<Real>);
}

TYPED_TEST(Angles, PhiIsWhereTheForceComesFrom) {
  using Force = typename TypeParam::Force;
  using Real = typename TypeParam::Real;
  const Real quarter = std::numbers::pi_v<Real> / 2;
  const Real eighth = quarter / 2;
  EXPECT_EQ(direction_of(Force{-1, 0, 0}).phi, 0);
  EXPECT_EQ(direction_of(Force{-1, -1, 0}).phi, eighth);
  EXPECT_EQ(direction_of(Force{0, -1, 0}).phi, quarter);
  EXPECT_EQ(direction_of(Force{1, -1, 0}).phi, 3 * eighth);
  EXPECT_EQ(direction_of(Force{1, 1, 0}).phi, -3 * eighth);
  EXPECT_EQ(direction_of(Force{0, 1, 0}).phi, -quarter);
  EXPECT_EQ(direction_of(Force{-1, 1, 0}).phi, -eighth);
  EXPECT_EQ(direction_of(Force{-1, 0, 0}).theta, quarter);
}

TYPED_TEST(Angles, TheCutBelongsToPlusPi) {
  using Force = typename TypeParam::Force;
  using Real = typename TypeParam::Real;
  EXPECT_EQ(direction_of(Force{1, Real{0}, 1}).phi, std::numbers::pi_v<Real>);
  EXPECT_EQ(direction_of(Force{1, -Real{0}, 1}).phi, std::numbers::pi_v<Real>);
}

TYPED_TEST(Angles, NeitherOverflowNorVanish) {
  using Force = typename TypeParam::Force;
  using Limits = std::numeric_limits<typename TypeParam::Real>;
  const auto large = direction_of(Force{Limits::max() / 4, Limits::max() / 4, Limits::max() / 4});
  EXPECT_TRUE(std::isfinite(large.magnitude));
  EXPECT_NEAR(large.theta, std::atan(std::numbers::sqrt2), 1e-6);
  const auto small = direction_of(Force{-Limits::min(), 0, Limits::min()});
  EXPECT_GT(small.magnitude, Limits::min());
  EXPECT_NEAR(small.theta, std::numbers::pi / 4, 1e-6);
}

}  // namespace
}  // namespace pillarfield
