// The feasible segment of host/solve/segment.h equals that of the direct solve
// (docs/derivations/segment.md).

#include "solve/segment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pillars.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

/// A pillar of region 3 and its results of the direct solve.
struct AmbiguousPillar {
  maths::Diagonals diagonals{};
  maths::ParitySum sum{};
  maths::Force point{};
  int status = 0;
};

constexpr maths::ForceScale kScale = {0.35355339F, 0.5F};  // of 1 count per newton

maths::Sensel sensel_of(double reading) {
  return maths::classify(maths::raw_sensel(static_cast<float>(reading)), 0.0F);
}

constexpr auto kPoint = static_cast<float>(kSegmentPoint);

AmbiguousPillar ambiguous_pillar(const maths::Readings& v, float segment_point) {
  const maths::Pillar sensels = {sensel_of(v.v1), sensel_of(v.v2), sensel_of(v.v3),
                                 sensel_of(v.v4)};
  AmbiguousPillar pillar;
  pillar.diagonals = maths::pillar_diagonals(sensels);
  pillar.sum = maths::parity_sum(pillar.diagonals, segment_point);
  pillar.point = maths::direct_force(pillar.diagonals, pillar.sum, kScale);
  pillar.status = maths::direct_status(sensels, pillar.diagonals, pillar.sum, 0);
  return pillar;
}

/// Calls `check(pillar, truth)` for forces from all azimuths under which two adjacent sensels are
/// inactive.
template <class Check>
void for_ambiguous_pillars(Check check, float segment_point = kPoint) {
  int ambiguous_pillars = 0;
  for (int azimuth = 0; azimuth < 360; azimuth += 1) {
    for (const double ratio : {1.45, 1.6, 2.0, 3.0, 8.0}) {
      const double angle = azimuth * std::numbers::pi / 180;
      const maths::Force truth = {static_cast<float>(40 * ratio * std::cos(angle)),
                                  static_cast<float>(40 * ratio * std::sin(angle)), 40};
      const AmbiguousPillar pillar =
          ambiguous_pillar(maths::model_readings(truth, 1), segment_point);
      if (!has_feasible_segment(static_cast<std::uint8_t>(pillar.status))) continue;
      ++ambiguous_pillars;
      check(pillar, truth);
    }
  }
  EXPECT_GT(ambiguous_pillars, 500);
}

double ratio_of(const maths::Force& force) {
  return std::hypot(force.shear_x, force.shear_y) / force.normal;
}

FeasibleSegment segment_of(const AmbiguousPillar& pillar) {
  return pillarfield::segment_of(pillar.point, static_cast<std::uint8_t>(pillar.status), {}, {});
}

TEST(FeasibleSegment, HoldsTheForcesOfTheDirectSolve) {
  for (const float at : {0.5F, kPoint, 1.0F}) {
    for_ambiguous_pillars(
        [](const AmbiguousPillar& pillar, const maths::Force&) {
          const auto status = static_cast<std::uint8_t>(pillar.status);
          const float high = segment_of(pillar).high;
          EXPECT_NEAR(high, pillar.sum.high * kScale.normal, 1e-4);
          for (const float part : {0.0F, 0.25F, 0.7F, 1.0F}) {
            const maths::Force here = force_on_segment(pillar.point, status, {}, part * high);
            const maths::Force there =
                maths::force_at(pillar.diagonals, part * pillar.sum.high, kScale);
            ASSERT_NEAR(here.shear_x, there.shear_x, 1e-4);
            ASSERT_NEAR(here.shear_y, there.shear_y, 1e-4);
            ASSERT_NEAR(here.normal, there.normal, 1e-4);
          }
        },
        at);
  }
}

TEST(FeasibleSegment, IsTheSameOfEachOfItsForces) {
  for_ambiguous_pillars([](const AmbiguousPillar& pillar, const maths::Force&) {
    const auto status = static_cast<std::uint8_t>(pillar.status);
    const FeasibleSegment segment = segment_of(pillar);
    for (const float part : {0.01F, 0.3F, 1.0F}) {
      const maths::Force other = force_on_segment(pillar.point, status, {}, part * segment.high);
      const FeasibleSegment again = pillarfield::segment_of(other, status, {}, {});
      ASSERT_NEAR(again.known_shear, segment.known_shear, 1e-4);
      ASSERT_NEAR(again.free_shear, segment.free_shear, 1e-4);
      ASSERT_NEAR(again.high, segment.high, 1e-4);
    }
  });
}

TEST(FeasibleSegment, TheTruthHasItsRatio) {
  for_ambiguous_pillars([](const AmbiguousPillar& pillar, const maths::Force& truth) {
    ASSERT_NEAR(segment_of(pillar).ratio_at(truth.normal), ratio_of(truth), 1e-4 * ratio_of(truth));
  });
}

TEST(FeasibleSegment, RatiosFallAsTheNormalForceGrows) {
  for_ambiguous_pillars([](const AmbiguousPillar& pillar, const maths::Force&) {
    const FeasibleSegment segment = segment_of(pillar);
    double before = segment.ratio_at(0.01 * segment.high);
    for (int step = 1; step <= 30; ++step) {
      const double ratio = segment.ratio_at(double{segment.high} * step / 30);
      ASSERT_LT(ratio, before);
      before = ratio;
    }
  });
}

/// A shear coefficient stretches the segment, off-centre pressure shifts it; neither changes which
/// normal forces it has.
TEST(FeasibleSegment, FollowsTheCoefficientsAndOffCentrePressure) {
  SensorEffects effects;
  effects.shear_coefficient = {0.8, 1.3};
  const SegmentModel model = segment_model(effects, 1);
  const LeanShear lean = {90, -120, 0};  // beyond the shear of most pillars
  const auto corrected = [&](const maths::Force& force) {
    return maths::Force{force.shear_x / model.coefficient_x - lean.x,
                        force.shear_y / model.coefficient_y - lean.y, force.normal};
  };
  int flipped = 0;
  for_ambiguous_pillars([&](const AmbiguousPillar& pillar, const maths::Force& truth) {
    const auto status = static_cast<std::uint8_t>(pillar.status);
    const maths::Force point = corrected(pillar.point);
    const bool vertical = shear_y_is_free(status);
    flipped += std::signbit(vertical ? point.shear_y : point.shear_x) !=
               std::signbit(sign_of_free_shear(status));
    SegmentModel direct = model;
    direct.point = kPoint;
    const float high = pillar.sum.high * kScale.normal;
    ASSERT_NEAR(pillarfield::segment_of(point, status, direct, {}).high, high, 1e-3);
    for (const float part : {0.0F, 0.3F, 0.7F, 1.0F}) {
      const maths::Force here = force_on_segment(point, status, model, part * high);
      const maths::Force there =
          corrected(maths::force_at(pillar.diagonals, part * pillar.sum.high, kScale));
      ASSERT_NEAR(here.shear_x, there.shear_x, 1e-3);
      ASSERT_NEAR(here.shear_y, there.shear_y, 1e-3);
      ASSERT_NEAR(pillarfield::segment_of(here, status, model, lean).high, high, 1e-3);
    }
    const FeasibleSegment segment = pillarfield::segment_of(point, status, model, lean);
    const double ratio = ratio_of(corrected(truth));
    ASSERT_NEAR(segment.ratio_at(truth.normal), ratio, 1e-4 * ratio);
    const double least = segment.ratio_at(segment.least_ratio_normal());
    for (int step = 1; step <= 40; ++step) {
      ASSERT_GE(segment.ratio_at(double{segment.high} * step / 40), least * (1 - 1e-6));
    }
  });
  EXPECT_GT(flipped, 50);
}

TEST(FeasibleSegment, ScalesWithTheForce) {
  const maths::Force force = {-0.3F, 1.2F, 0.5F};
  const FeasibleSegment one = pillarfield::segment_of(force, 3, {}, {});
  for (const float scale : {1e-12F, 1e-3F, 1e6F, 1e15F}) {
    const FeasibleSegment other = pillarfield::segment_of(
        {scale * force.shear_x, scale * force.shear_y, scale * force.normal}, 3, {}, {});
    EXPECT_NEAR(other.known_shear / scale, one.known_shear, 1e-6);
    EXPECT_NEAR(other.free_shear / scale, one.free_shear, 1e-6);
    EXPECT_NEAR(other.high / scale, one.high, 1e-6);
  }
}

}  // namespace
}  // namespace pillarfield
