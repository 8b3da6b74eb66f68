// The segment of an ambiguous pillar: what host/solve/segment.h says of it is what the direct
// solve says (docs/derivations/segment.md).

#include "solve/segment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pillars.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

/// A pillar of region 3, with all that the direct solve knows of it.
struct OpenPillar {
  maths::Diagonals diagonals{};
  maths::ParitySum sum{};
  maths::Force point{};
  int status = 0;
};

constexpr maths::ForceScale kScale = {0.35355339F, 0.5F};  // of one count a newton

maths::Sensel sensel_of(double reading) {
  return maths::classify(maths::raw_sensel(static_cast<float>(reading)), 0.0F);
}

constexpr auto kPoint = static_cast<float>(kSegmentPoint);

OpenPillar open_pillar(const maths::Readings& v, float segment_point) {
  const maths::Pillar pillar = {sensel_of(v.v1), sensel_of(v.v2), sensel_of(v.v3), sensel_of(v.v4)};
  OpenPillar open;
  open.diagonals = maths::pillar_diagonals(pillar);
  open.sum = maths::parity_sum(open.diagonals, segment_point);
  open.point = maths::direct_force(open.diagonals, open.sum, kScale);
  open.status = maths::direct_status(pillar, open.diagonals, open.sum, 0);
  return open;
}

/// Calls `check(open, truth)` for forces from all round that lift two adjacent sensels.
template <class Check>
void for_open_pillars(Check check, float segment_point = kPoint) {
  int open_pillars = 0;
  for (int azimuth = 0; azimuth < 360; azimuth += 1) {
    for (const double ratio : {1.45, 1.6, 2.0, 3.0, 8.0}) {
      const double angle = azimuth * std::numbers::pi / 180;
      const maths::Force truth = {static_cast<float>(40 * ratio * std::cos(angle)),
                                  static_cast<float>(40 * ratio * std::sin(angle)), 40};
      const OpenPillar open = open_pillar(maths::model_readings(truth, 1), segment_point);
      if (!is_ambiguous(static_cast<std::uint8_t>(open.status))) continue;
      ++open_pillars;
      check(open, truth);
    }
  }
  EXPECT_GT(open_pillars, 500);
}

double ratio_of(const maths::Force& force) {
  return std::hypot(force.shear_x, force.shear_y) / force.normal;
}

Segment segment_of(const OpenPillar& open) {
  return pillarfield::segment_of(open.point,
                                 moves_vertically(static_cast<std::uint8_t>(open.status)), {});
}

TEST(Segment, HoldsTheForcesOfTheDirectSolve) {
  for (const float at : {0.5F, kPoint, 1.0F}) {
    for_open_pillars(
        [](const OpenPillar& open, const maths::Force&) {
          const bool vertical = moves_vertically(static_cast<std::uint8_t>(open.status));
          const float high = segment_of(open).high;
          EXPECT_NEAR(high, open.sum.high * kScale.normal, 1e-4);
          for (const float part : {0.0F, 0.25F, 0.7F, 1.0F}) {
            const maths::Force here = force_on_segment(open.point, vertical, part * high);
            const maths::Force there =
                maths::force_at(open.diagonals, part * open.sum.high, kScale);
            ASSERT_NEAR(here.shear_x, there.shear_x, 1e-4);
            ASSERT_NEAR(here.shear_y, there.shear_y, 1e-4);
            ASSERT_NEAR(here.normal, there.normal, 1e-4);
          }
        },
        at);
  }
}

TEST(Segment, IsTheSameOfEachOfItsForces) {
  for_open_pillars([](const OpenPillar& open, const maths::Force&) {
    const bool vertical = moves_vertically(static_cast<std::uint8_t>(open.status));
    const Segment segment = segment_of(open);
    for (const float part : {0.01F, 0.3F, 1.0F}) {
      const maths::Force other = force_on_segment(open.point, vertical, part * segment.high);
      const Segment again = pillarfield::segment_of(other, vertical, {});
      ASSERT_NEAR(again.fixed, segment.fixed, 1e-4);
      ASSERT_NEAR(again.moving, segment.moving, 1e-4);
      ASSERT_NEAR(again.high, segment.high, 1e-4);
    }
  });
}

TEST(Segment, TheTruthHasItsRatio) {
  for_open_pillars([](const OpenPillar& open, const maths::Force& truth) {
    ASSERT_NEAR(segment_of(open).ratio_at(truth.normal), ratio_of(truth), 1e-4 * ratio_of(truth));
  });
}

TEST(Segment, RatiosFallAsTheNormalForceGrows) {
  for_open_pillars([](const OpenPillar& open, const maths::Force&) {
    const Segment segment = segment_of(open);
    double before = segment.ratio_at(0.01 * segment.high);
    for (double step = 1; step <= 30; ++step) {
      const double ratio = segment.ratio_at(double{segment.high} * step / 30);
      ASSERT_LT(ratio, before);
      before = ratio;
    }
  });
}

TEST(Segment, ScalesWithTheForce) {
  const maths::Force force = {-0.3F, 1.2F, 0.5F};
  const Segment one = pillarfield::segment_of(force, true, {});
  for (const float scale : {1e-12F, 1e-3F, 1e6F, 1e15F}) {
    const Segment other = pillarfield::segment_of(
        {scale * force.shear_x, scale * force.shear_y, scale * force.normal}, true, {});
    EXPECT_NEAR(other.fixed / scale, one.fixed, 1e-6);
    EXPECT_NEAR(other.moving / scale, one.moving, 1e-6);
    EXPECT_NEAR(other.high / scale, one.high, 1e-6);
  }
}

}  // namespace
}  // namespace pillarfield
