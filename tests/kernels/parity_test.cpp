// Both consistency tests: the parity residual, and the excess of an inactive sensel.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "pillarfield/status.h"
#include "pillars.h"

namespace pillarfield {
namespace {

template <class Precision>
class Parity : public testing::Test {
 protected:
  static bool fails(const PillarOf<Precision>& pillar, RealOf<Precision> tolerance) {
    const auto sum =
        parity_sum(pillar_diagonals(pillar), static_cast<RealOf<Precision>>(kSegmentPoint));
    return fails_parity(pillar, sum, tolerance) != 0;
  }

  static FourReadings<Precision> turned(const FourReadings<Precision>& readings,
                                        std::size_t turns) {
    FourReadings<Precision> result;
    for (std::size_t n = 0; n < 4; ++n) result[(n + turns) % 4] = readings[n];
    return result;
  }
};
TYPED_TEST_SUITE(Parity, Precisions, PrecisionNames);

TYPED_TEST(Parity, ResidualPassesUpToItsTolerance) {
  using Real = RealOf<TypeParam>;
  // 30 + 22 - 20 - 24 = 8
  for (std::size_t turns = 0; turns < 4; ++turns) {
    const auto pillar = pillar_of<TypeParam>(TestFixture::turned({30, 20, 22, 24}, turns));
    EXPECT_FALSE(TestFixture::fails(pillar, 8));
    EXPECT_TRUE(TestFixture::fails(pillar, std::nextafter(Real{8}, Real{0})));
    const auto threshold =
        pillar_of<TypeParam>(TestFixture::turned({30, 20, 22, 24}, turns), Real{19});
    EXPECT_TRUE(TestFixture::fails(threshold, 7)) << "the threshold hides no usable reading";
  }
}

TYPED_TEST(Parity, ExcessPassesUpToThresholdAndTolerance) {
  using Real = RealOf<TypeParam>;
  // Sensel 1 is inactive although parity predicts 20 + 24 - 33 = 11 counts for it.
  for (std::size_t turns = 0; turns < 4; ++turns) {
    const auto under = [&](Real threshold) {
      return pillar_of<TypeParam>(TestFixture::turned({0, 20, 33, 24}, turns), threshold);
    };
    EXPECT_FALSE(TestFixture::fails(under(5), 6));
    EXPECT_TRUE(TestFixture::fails(under(5), Real{6 - 0x1p-20}));
    EXPECT_TRUE(TestFixture::fails(under(4), 6));
  }
}

TYPED_TEST(Parity, ANegativePredictionPasses) {
  // Parity predicts 20 + 24 - 90 = -46 counts for sensel 1, as under a pillar that lifts off.
  for (std::size_t turns = 0; turns < 4; ++turns) {
    const auto pillar = pillar_of<TypeParam>(TestFixture::turned({0, 20, 90, 24}, turns));
    EXPECT_FALSE(TestFixture::fails(pillar, 0));
  }
}

TYPED_TEST(Parity, ADeadZoneRaisesTheBoundOfAnInactiveSensel) {
  using Real = RealOf<TypeParam>;
  auto pillar = pillar_of<TypeParam>({0, 20, 33, 24});
  EXPECT_TRUE(TestFixture::fails(pillar, 6));
  pillar.s1 = fill_dead_zone(pillar.s1, Real{5});
  EXPECT_FALSE(TestFixture::fails(pillar, 6));
}

TYPED_TEST(Parity, AnInactiveSenselThatMayBeLoadedLeavesTheRegionAmbiguous) {
  using Real = RealOf<TypeParam>;
  const auto ambiguous = [](const PillarOf<TypeParam>& pillar, Real margin) {
    const auto diagonals = pillar_diagonals(pillar);
    return (direct_status(pillar, diagonals,
                          parity_sum(diagonals, static_cast<Real>(kSegmentPoint)), margin) &
            status::kAmbiguous) != 0;
  };
  for (std::size_t turns = 0; turns < 4; ++turns) {
    const auto under = [&](Real opposite, Real threshold) {
      return pillar_of<TypeParam>(TestFixture::turned({0, 20, opposite, 24}, turns), threshold);
    };
    // Parity predicts 44 - 41 = 3 counts for sensel 1, then -3.
    EXPECT_TRUE(ambiguous(under(41, 5), 0));
    EXPECT_FALSE(ambiguous(under(47, 5), 0));
    EXPECT_FALSE(ambiguous(under(47, 5), 3)) << "at the margin, not within it";
    EXPECT_TRUE(ambiguous(under(47, 5), Real{3.25}));
    EXPECT_FALSE(ambiguous(under(41, 0), 9)) << "the bound of the inactive sensel is zero";
  }
  const auto four = pillar_of<TypeParam>({20, 20, 20, 20}, 5);
  EXPECT_FALSE(ambiguous(four, 9));
}

TYPED_TEST(Parity, NothingRedundantNeverFails) {
  using Real = RealOf<TypeParam>;
  for (const States& states : all_states()) {
    const auto pillar = pillar_in<TypeParam>(states, {100, 1, 90, 2});
    const auto usable = std::ranges::count(states, State::usable);
    const auto inactive = std::ranges::count(states, State::inactive);
    const bool redundant = usable == 4 || (usable == 3 && inactive == 1);
    if (!redundant) {
      EXPECT_FALSE(TestFixture::fails(pillar, Real{0})) << name_of(states);
    }
  }
}

TYPED_TEST(Parity, ConsistentForcesPassWithinRounding) {
  using Real = RealOf<TypeParam>;
  Random random(21);
  for (int i = 0; i < 20'000; ++i) {
    const double magnitude = random.decades(1e-6, 1e6);
    const auto readings = rounded_readings<TypeParam>(random.force(magnitude), 100);
    const Real tolerance = static_cast<Real>(4 * ulp_at<Real>(200 * magnitude));
    EXPECT_FALSE(TestFixture::fails(pillar_of<TypeParam>(readings), tolerance));
  }
}

}  // namespace
}  // namespace pillarfield
