// Turning, mirroring and scaling a pillar turns, mirrors and scales its force, bit for bit.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "pillars.h"

namespace pillarfield {
namespace {

/// The power of two in `bits` shuffled: sensel n of the old pillar is sensel place[n] of the new.
using Places = std::array<std::size_t, 4>;

int moved_usable_bits(int status, const Places& places) {
  int moved = status & ~15;
  for (std::size_t n = 0; n < 4; ++n) {
    if ((status >> n & 1) != 0) moved |= 1 << places[n];
  }
  return moved;
}

template <class Precision>
class DirectSolveSymmetry : public testing::Test {
 protected:
  static PillarOf<Precision> moved(const PillarOf<Precision>& pillar, const Places& places) {
    const std::array old = {pillar.s1, pillar.s2, pillar.s3, pillar.s4};
    std::array moved = old;
    for (std::size_t n = 0; n < 4; ++n) moved[places[n]] = old[n];
    return {moved[0], moved[1], moved[2], moved[3]};
  }

  static void expect_same(const ForceOf<Precision>& actual, const ForceOf<Precision>& expected) {
    EXPECT_EQ(actual.shear_x, expected.shear_x);
    EXPECT_EQ(actual.shear_y, expected.shear_y);
    EXPECT_EQ(actual.normal, expected.normal);
  }

  /// `move_force` does to a force what moving the sensels to `places` does to a pillar.
  template <class MoveForce>
  static void expect_symmetry(const Places& places, MoveForce move_force) {
    Random random(41);
    for (const States& states : all_states()) {
      SCOPED_TRACE(name_of(states));
      for (int i = 0; i < 40; ++i) {
        const PillarOf<Precision> pillar =
            dead_zoned(pillar_in<Precision>(states, drawn_readings(random)));
        const auto before = solve<Precision>(pillar, 3);
        const auto after = solve<Precision>(moved(pillar, places), 3);
        expect_same(after.force, move_force(before.force));
        expect_same(after.low(), move_force(before.low()));
        expect_same(after.high(), move_force(before.high()));
        EXPECT_EQ(after.status, moved_usable_bits(before.status, places));
        EXPECT_EQ(fails_parity(moved(pillar, places), after.sum, RealOf<Precision>{2}),
                  fails_parity(pillar, before.sum, RealOf<Precision>{2}));
      }
    }
  }

  static FourReadings<Precision> drawn_readings(Random& random) {
    FourReadings<Precision> readings;
    for (RealOf<Precision>& reading : readings)
      reading = static_cast<RealOf<Precision>>(random.decades(0.1, 100));
    return readings;
  }

 private:
  static PillarOf<Precision> dead_zoned(PillarOf<Precision> pillar) {
    pillar.s1 = fill_dead_zone(pillar.s1, RealOf<Precision>{0.5});
    pillar.s2 = fill_dead_zone(pillar.s2, RealOf<Precision>{0.5});
    pillar.s3 = fill_dead_zone(pillar.s3, RealOf<Precision>{0.5});
    pillar.s4 = fill_dead_zone(pillar.s4, RealOf<Precision>{0.5});
    return pillar;
  }
};
TYPED_TEST_SUITE(DirectSolveSymmetry, Precisions, PrecisionNames);

/// All other symmetries of a square are made of this one and the next.
TYPED_TEST(DirectSolveSymmetry, QuarterTurn) {
  using Force = ForceOf<TypeParam>;
  TestFixture::expect_symmetry({1, 2, 3, 0}, [](const Force& force) {
    return Force{-force.shear_y, force.shear_x, force.normal};
  });
}

TYPED_TEST(DirectSolveSymmetry, LeftAndRight) {
  using Force = ForceOf<TypeParam>;
  TestFixture::expect_symmetry({1, 0, 3, 2}, [](const Force& force) {
    return Force{-force.shear_x, force.shear_y, force.normal};
  });
}

TYPED_TEST(DirectSolveSymmetry, PowersOfTwoScaleExactly) {
  using Real = RealOf<TypeParam>;
  using Force = ForceOf<TypeParam>;
  Random random(42);
  for (const States& states : all_states()) {
    SCOPED_TRACE(name_of(states));
    const auto readings = TestFixture::drawn_readings(random);
    const Force force = solve<TypeParam>(pillar_in<TypeParam>(states, readings), 3).force;
    for (const int exponent : {-60, -1, 1, 7, 60}) {
      const Real factor = std::ldexp(Real{1}, exponent);
      auto scaled = readings;
      for (Real& reading : scaled) reading *= factor;
      TestFixture::expect_same(
          solve<TypeParam>(pillar_in<TypeParam>(states, scaled), 3).force,
          {force.shear_x * factor, force.shear_y * factor, force.normal * factor});
      TestFixture::expect_same(
          solve<TypeParam>(pillar_in<TypeParam>(states, readings), 3 * factor).force,
          {force.shear_x / factor, force.shear_y / factor, force.normal / factor});
    }
  }
}

TYPED_TEST(DirectSolveSymmetry, AnyFactorScalesWithinRounding) {
  using Real = RealOf<TypeParam>;
  using Force = ForceOf<TypeParam>;
  Random random(43);
  double worst = 0;
  for (const States& states : all_states()) {
    for (int i = 0; i < 50; ++i) {
      const auto readings = TestFixture::drawn_readings(random);
      const Real factor = static_cast<Real>(random.decades(1e-6, 1e6));
      auto scaled = readings;
      for (Real& reading : scaled) reading *= factor;
      const Force force = solve<TypeParam>(pillar_in<TypeParam>(states, readings), 3).force;
      const Force larger = solve<TypeParam>(pillar_in<TypeParam>(states, scaled), 3).force;
      const oracle::Force expected = {oracle::Exact(force.shear_x) * factor,
                                      oracle::Exact(force.shear_y) * factor,
                                      oracle::Exact(force.normal) * factor};
      worst = std::max(worst, force_ulps<TypeParam>(larger, expected));
    }
  }
  std::printf("any factor: worst difference %.3f ULP of the magnitude\n", worst);
  // Twice the solve's own 4 ULP, and the rounding of four scaled readings.
  EXPECT_LE(worst, 12);
}

}  // namespace
}  // namespace pillarfield
