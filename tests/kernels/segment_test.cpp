// The segment of an ambiguous pillar: what kernels/maths/segment.h says of it is what the direct
// solve says (docs/derivations/field.md, F1 to F5).

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
      if (!maths::is_open(static_cast<std::uint8_t>(open.status))) continue;
      ++open_pillars;
      check(open, truth);
    }
  }
  EXPECT_GT(open_pillars, 500);
}

double ratio_of(const maths::Force& force) {
  return std::hypot(force.shear_x, force.shear_y) / force.normal;
}

TEST(Segment, HoldsTheForcesOfTheDirectSolve) {
  for (const float at : {0.5F, kPoint, 1.0F}) {
    for_open_pillars(
        [at](const OpenPillar& open, const maths::Force&) {
          const bool vertical = maths::moves_vertically(open.status);
          const float high = maths::segment_of(open.point, vertical, at).high;
          EXPECT_NEAR(high, open.sum.high * kScale.normal, 1e-4);
          for (const float part : {0.0F, 0.25F, 0.7F, 1.0F}) {
            const maths::Force here = maths::force_on_segment(open.point, vertical, part * high);
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

TEST(Segment, TheTruthIsWhereItsRatioIs) {
  for_open_pillars([](const OpenPillar& open, const maths::Force& truth) {
    const bool vertical = maths::moves_vertically(open.status);
    const maths::Segment segment = maths::segment_of(open.point, vertical, kPoint);
    const auto ratio = static_cast<float>(ratio_of(truth));
    ASSERT_NEAR(maths::normal_at_ratio(segment, ratio), truth.normal, 2e-3);
    ASSERT_NEAR(maths::ratio_on_segment(segment, truth.normal), ratio, 1e-4 * ratio);
  });
}

TEST(Segment, RatiosFallAsTheNormalForceGrows) {
  for_open_pillars([](const OpenPillar& open, const maths::Force&) {
    const maths::Segment segment =
        maths::segment_of(open.point, maths::moves_vertically(open.status), kPoint);
    float before = segment.high;
    const float least = maths::ratio_on_segment(segment, segment.high);
    for (int step = 0; step < 30; ++step) {
      const float normal =
          maths::normal_at_ratio(segment, least * (1 + 0.2F * static_cast<float>(step)));
      ASSERT_LE(normal, before * 1.00001F);
      before = normal;
    }
  });
}

TEST(Segment, HalfwayIsInTheMiddleOfTheThetas) {
  for_open_pillars([](const OpenPillar& open, const maths::Force&) {
    const maths::Segment segment =
        maths::segment_of(open.point, maths::moves_vertically(open.status), kPoint);
    const double least = std::atan(maths::ratio_on_segment(segment, segment.high));
    const float whole = maths::between_thetas(segment, 0, segment.high, 0.5F);
    ASSERT_NEAR(std::atan(maths::ratio_on_segment(segment, whole)),
                (least + std::numbers::pi / 2) / 2, 1e-5);
    const float low = 0.6F * segment.high;
    const double most = std::atan(maths::ratio_on_segment(segment, low));
    const float part = maths::between_thetas(segment, low, segment.high, 0.5F);
    ASSERT_NEAR(std::atan(maths::ratio_on_segment(segment, part)), (least + most) / 2, 1e-5);
    ASSERT_NEAR(maths::between_thetas(segment, low, segment.high, 1.0F), low, 1e-4 * low);
  });
}

TEST(Segment, ScalesWithTheForce) {
  const maths::Segment one = {0.3F, 1.2F, 0.5F};
  for (const float scale : {1e-12F, 1e-3F, 1e6F, 1e15F}) {
    const maths::Segment other = {0.3F * scale, 1.2F * scale, 0.5F * scale};
    EXPECT_NEAR(maths::normal_at_ratio(other, 2) / scale, maths::normal_at_ratio(one, 2), 1e-6);
  }
  EXPECT_EQ(maths::normal_at_ratio({0, 0, 0}, 2), 0);
}

}  // namespace
}  // namespace pillarfield
