// The fit of a pressure's trend to pillars that are resolved and to such that slip, and what
// becomes of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/pillar_maths.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

constexpr std::uint32_t kSide = 25;
constexpr double kPeak = 100;
constexpr double kFriction = 2;

/// A round contact in a skin that ends with it, so that no edge is in sight: pillars near the
/// centre are resolved, all others slip along an axis.
class RoundContact {
 public:
  /// `core` is the radius of what is resolved, in pillars; `flatness` of the pressure's square, a
  /// term of the fourth degree.
  RoundContact(double core, double flatness);

  [[nodiscard]] double pressure(std::uint32_t row, std::uint32_t col) const {
    const double r2 = square_of(row, col);
    return kPeak * std::sqrt(1 - r2 + flatness_ * r2 * (1 - r2));
  }

  /// Adds this share to forces, and takes it away, by turns.
  void ruffle(double share);

  /// The sums of the contact's pillars by a trend, made equations.
  [[nodiscard]] maths::NormalEquations equations(const maths::Trend& trend);

  maths::Tile tile{0, 0, kSide, kSide, 0, 0, 0, 0};
  maths::Cells cells{};

 private:
  [[nodiscard]] static double square_of(std::uint32_t row, std::uint32_t col);

  double flatness_;
  std::vector<std::uint8_t> kind_;
  std::vector<std::vector<float>> planes_;
  std::vector<double> lines_;
};

RoundContact::RoundContact(double core, double flatness)
    : flatness_(flatness),
      kind_(std::size_t{kSide + 2} * (kSide + 2), PF_CELL_BEYOND),
      planes_(6, std::vector<float>(kind_.size())),
      lines_(std::size_t{PF_LINE_SUMS} * kSide) {
  cells = {kind_.data(),      planes_[0].data(), planes_[1].data(), planes_[2].data(),
           planes_[3].data(), planes_[4].data(), planes_[5].data()};
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t col = 0; col < kSide; ++col) {
      const double r2 = square_of(row, col);
      if (r2 > 0.95) continue;
      const std::uint32_t cell = maths::cell_at(tile, row, col);
      const double normal = pressure(row, col);
      cells.weight[cell] = 1;
      if (std::sqrt(r2) * (kSide / 2.0) < core) {
        cells.kind[cell] = PF_CELL_RESOLVED;
        cells.top[cell] = static_cast<float>(normal);
      } else {
        cells.kind[cell] = PF_CELL_AMBIGUOUS;
        const double moving = (kFriction + std::numbers::sqrt2) * normal;
        cells.moving[cell] = static_cast<float>(moving);
        cells.top[cell] = static_cast<float>(moving / (2 * std::numbers::sqrt2));
      }
    }
  }
}

double RoundContact::square_of(std::uint32_t row, std::uint32_t col) {
  const double x = (col - 0.5 * (kSide - 1)) / (kSide / 2.0);
  const double y = (row - 0.5 * (kSide - 1)) / (kSide / 2.0);
  return x * x + y * y;
}

void RoundContact::ruffle(double share) {
  double sign = 1;
  for (std::size_t cell = 0; cell < kind_.size(); ++cell) {
    if (kind_[cell] < PF_CELL_RESOLVED) continue;
    cells.top[cell] *= static_cast<float>(1 + sign * share);
    cells.moving[cell] *= static_cast<float>(1 + sign * share);
    sign = -sign;
  }
}

maths::NormalEquations RoundContact::equations(const maths::Trend& trend) {
  maths::sum_lines(tile, cells, &trend, static_cast<float>(kPeak), lines_.data(), {0, 1});
  return maths::normal_equations(tile, trend.degree, lines_.data());
}

/// A trend that takes every ambiguous pillar for slipping.
maths::Trend blank_trend(std::uint32_t degree, double friction) {
  maths::Trend trend = maths::no_trend(degree, true);
  trend.friction = static_cast<float>(friction);
  return trend;
}

/// Solves and assesses.
void fit(RoundContact& contact, maths::Trend& trend) {
  const maths::NormalEquations equations = contact.equations(trend);
  const double precision = maths::solve_trend(equations, &trend);
  maths::assess_trend(&equations, precision, &trend);
}

double value_at(const RoundContact& contact, const maths::Trend& trend, std::uint32_t row,
                std::uint32_t col) {
  const maths::Frame frame = maths::frame_of(contact.tile);
  const maths::TrendLine line = maths::trend_line(&trend, (frame.row - row) * frame.scale);
  return maths::on_line(&line, (col - frame.col) * frame.scale);
}

/// What a pillar bears at another friction, as a share of what it does bear.
double scale_of(double friction) {
  return (kFriction + std::numbers::sqrt2) / (friction + std::numbers::sqrt2);
}

TEST(FieldFit, FindsByWhatFactorSlippingPillarsAreOff) {
  for (const double friction : {1.6, 2.0, 2.7}) {
    RoundContact contact(8, 0.5);
    maths::Trend trend = blank_trend(4, friction);
    fit(contact, trend);
    EXPECT_NEAR(trend.scale * std::pow(scale_of(friction), 2), 1, 1e-4) << friction;
    EXPECT_LT(trend.unexplained, 1e-5);
    EXPECT_LT(trend.scale_error, 1e-4);
    for (std::uint32_t col = 1; col < kSide - 1; ++col) {
      EXPECT_NEAR(value_at(contact, trend, kSide / 2, col),
                  std::pow(contact.pressure(kSide / 2, col), 2), 1e-3 * kPeak * kPeak);
    }
  }
}

TEST(FieldFit, TakesSlippingPillarsAtTheirWordWhereTheFrictionIsTold) {
  RoundContact contact(8, 0);
  maths::Trend trend = blank_trend(2, kFriction);
  trend.told = true;
  fit(contact, trend);
  EXPECT_EQ(trend.scale, 1);
  EXPECT_LT(trend.unexplained, 1e-5);
  EXPECT_EQ(trend.scale_error, 0);
  // At a wrong friction the two do not fit each other.
  trend = blank_trend(2, 1.5);
  trend.told = true;
  fit(contact, trend);
  EXPECT_GT(trend.unexplained, 0.02);
}

TEST(FieldFit, WhatATrendCannotFollowIsToldAsUnexplained) {
  RoundContact contact(8, 1);
  maths::Trend round = blank_trend(4, 1.7);
  maths::Trend stiff = blank_trend(2, 1.7);
  fit(contact, round);
  fit(contact, stiff);
  EXPECT_LT(round.unexplained, 1e-5);
  EXPECT_GT(stiff.unexplained, 0.01);
}

TEST(FieldFit, ItsErrorIsWithinWhatItSaysAndGrowsWithTheNoise) {
  const auto error_of = [](double core, double noise) {
    RoundContact contact(core, 0);
    contact.ruffle(noise);
    maths::Trend trend = blank_trend(2, 1.7);
    fit(contact, trend);
    const double off = trend.scale * std::pow(scale_of(1.7), 2) - 1;
    EXPECT_LT(std::abs(off) / 2, 4 * trend.scale_error) << "core " << core << ", noise " << noise;
    return trend.scale_error;
  };
  const double usual = error_of(8, 0.01);
  EXPECT_NEAR(error_of(8, 0.02) / usual, 2, 0.2);
  EXPECT_GT(error_of(4, 0.01), 0);
}

TEST(FieldFit, PillarsThatStickByTheTrendDoNotJoinIt) {
  RoundContact contact(8, 0);
  maths::Trend trend = blank_trend(2, kFriction);
  fit(contact, trend);
  const double all = contact.equations(trend).weight;
  // A trend of twice the pressure has them bear more than they would in slip.
  for (double& term : trend.terms) term *= 4;
  EXPECT_LT(contact.equations(trend).weight, 0.5 * all);
}

/// A pillar that would bear 10 at friction 2, sheared along an axis.
maths::Segment segment() {
  const auto moving = static_cast<float>(10 * (2 + std::numbers::sqrt2));
  return {0, moving, moving / static_cast<float>(2 * std::numbers::sqrt2)};
}

maths::Verdict verdict_of(float spread) {
  maths::Verdict verdict = maths::verdict_by(PF_BY_SHAPE, 2);
  verdict.spread = spread;
  return verdict;
}

TEST(Judgement, WhoIsCertainStaysAndWhoIsNotLeansTowardsTheMiddle) {
  const maths::FieldSettings settings{};
  const float middle =
      maths::judged_normal(segment(), maths::verdict_by(PF_BY_NOTHING, 0), settings, 0).normal;
  float before = 0;
  for (const float spread : {0.0F, 0.02F, 0.1F, 0.3F}) {
    const maths::Judgement judged =
        maths::judged_normal(segment(), verdict_of(spread), settings, 0.1F);
    if (spread == 0) {
      EXPECT_NEAR(judged.normal, 10, 1e-4);
    }
    const float off = std::abs(judged.normal - 10);
    EXPECT_LE(off, std::abs(middle - 10));
    EXPECT_GE(off, before);
    EXPECT_LE(judged.low, judged.normal);
    EXPECT_GE(judged.high, judged.normal);
    before = off;
  }
  EXPECT_GT(before, 0.1F);
}

TEST(Judgement, TheBandOfAPillarThatSticksReachesToWhereItWouldSlip) {
  const maths::FieldSettings settings{};
  const maths::Judgement judged =
      maths::judged_normal(segment(), verdict_of(0.01F), settings, 11.8F);
  EXPECT_GT(judged.normal, 10.8F);
  EXPECT_LT(judged.low, 10);
  EXPECT_GT(judged.high, 11.8F);
  const float deviation = maths::deviation_of(judged);
  EXPECT_LE(judged.normal - 1.96F * deviation, 10);
  EXPECT_GE(judged.normal + 1.96F * deviation, 11.8F);
}

/// Whether a judgement is within its band, and the band within the segment, whatever the model has
/// the pillar bear.
void expect_within_band(const maths::Segment& of, const maths::Verdict& verdict,
                        const maths::FieldSettings& settings) {
  for (int step = 1; step <= 100; ++step) {
    const float shaped = of.high * static_cast<float>(step) / 100;
    const maths::Judgement judged = maths::judged_normal(of, verdict, settings, shaped);
    ASSERT_LE(judged.low, judged.normal) << shaped;
    ASSERT_GE(judged.high, judged.normal) << shaped;
    ASSERT_LE(judged.high, of.high) << shaped;
    ASSERT_GE(judged.low, 0) << shaped;
  }
}

TEST(Judgement, AnEstimateLiesInItsBandWhateverTheModelSays) {
  for (const float fixed : {0.0F, 0.3F, 1.0F, 3.0F}) {
    maths::Segment of = segment();
    of.fixed = fixed * of.moving;
    for (const float bound : {0.0F, 1.5F, 2.0F, 6.0F}) {
      maths::FieldSettings settings{};
      settings.friction = bound;
      for (const float spread : {0.0F, 0.01F, 0.1F, 0.2F, 0.5F}) {
        for (const float friction : {1.0F, 1.5F, 2.0F, 3.0F, 6.0F}) {
          SCOPED_TRACE(testing::Message() << "fixed " << fixed << ", bound " << bound << ", spread "
                                          << spread << ", friction " << friction);
          maths::Verdict verdict = verdict_of(spread);
          verdict.friction = friction;
          expect_within_band(of, verdict, settings);
          verdict.may_stick = 1;
          expect_within_band(of, verdict, settings);
        }
      }
    }
  }
}

TEST(Judgement, WhereOpenPillarsMayStickLittleAboveSlipIsRuledOut) {
  const maths::FieldSettings settings{};
  maths::Verdict verdict = maths::verdict_by(PF_BY_SLIP, 2);
  verdict.spread = 0.005F;
  EXPECT_LT(maths::judged_normal(segment(), verdict, settings, 0).high, 10.2F);
  verdict.may_stick = 1;
  const maths::Judgement judged = maths::judged_normal(segment(), verdict, settings, 0);
  EXPECT_NEAR(judged.normal, 10, 1e-4);
  EXPECT_NEAR(judged.high, 10 + 0.9 * (segment().high - 10), 1e-4);
}

TEST(Judgement, WhereOpenPillarsMayStickTheBandReachesTheModelsForceThoughTheySlip) {
  const maths::FieldSettings settings{};
  maths::Verdict verdict = verdict_of(0.002F);
  EXPECT_LT(maths::judged_normal(segment(), verdict, settings, 10.4F).high, 10.1F);
  verdict.may_stick = 1;
  const maths::Judgement judged = maths::judged_normal(segment(), verdict, settings, 10.4F);
  EXPECT_NEAR(judged.normal, 10, 0.01);
  EXPECT_GT(judged.high, 10.4F);
}

TEST(Judgement, APillarThatSlipsMayLieBeyondItsSegmentByTheNoise) {
  maths::FieldSettings settings{};
  const maths::Segment of = segment();
  for (const float noise : {0.0F, 0.1F, 10.0F}) {
    settings.noise = noise;
    maths::Verdict verdict = maths::verdict_by(PF_BY_SLIP, 1.38F);  // beyond the end, at 1.41
    const float slips = maths::normal_at_ratio(of, verdict.friction);
    ASSERT_GT(slips, of.high);
    EXPECT_FLOAT_EQ(maths::judged_normal(of, verdict, settings, 0).normal,
                    std::min(slips, of.high + 2 * noise));
    verdict.may_stick = 1;
    EXPECT_EQ(maths::judged_normal(of, verdict, settings, 0).normal, of.high);
    EXPECT_LE(maths::judged_normal(of, maths::verdict_by(PF_BY_NOTHING, 0), settings, 0).normal,
              of.high);
  }
}

TEST(Judgement, ABoundThatWasToldLeavesTheBandOfAPillarThatSticksAsWide) {
  maths::FieldSettings settings{};
  const maths::Verdict verdict = verdict_of(0.01F);
  const maths::Judgement free = maths::judged_normal(segment(), verdict, settings, 11.8F);
  settings.friction = 2;
  const maths::Judgement bounded = maths::judged_normal(segment(), verdict, settings, 11.8F);
  EXPECT_LT(bounded.low, 9.9F);
  EXPECT_EQ(bounded.high, free.high);
}

/// A segment by two readings, of sensels 1 and 2, N.
maths::Segment segment_by(double first, double second) {
  const double moving = (first + second) / std::numbers::sqrt2;
  return {static_cast<float>(std::abs(first - second) / std::numbers::sqrt2),
          static_cast<float>(moving), static_cast<float>(std::min(first, second) / 2)};
}

TEST(Judgement, NoiseAtARatioIsThatOfTheReadingsPassedOn) {
  for (const double second : {34.0, 30.0, 24.0}) {
    for (const float ratio : {1.5F, 2.0F, 3.0F}) {
      SCOPED_TRACE(testing::Message() << second << ", " << ratio);
      const auto normal = [&](double first, double other) {
        return double{maths::normal_at_ratio(segment_by(first, other), ratio)};
      };
      const double by_first = (normal(34.1, second) - normal(33.9, second)) / 0.2;
      const double by_second = (normal(34, second + 0.1) - normal(34, second - 0.1)) / 0.2;
      const maths::Segment of = segment_by(34, second);
      const double noise = maths::noise_at_ratio(of, maths::normal_at_ratio(of, ratio));
      EXPECT_NEAR(noise, double{PF_NOISE_AT_RATIO} * std::hypot(by_first, by_second), 1e-3);
    }
  }
  EXPECT_EQ(maths::noise_at_ratio({0, 0, 0}, 0), 0);
  EXPECT_EQ(maths::noise_at_ratio(segment(), 0), 0);
}

/// What a contact of 1000 pillars shows, of which so many tell a friction of 2.
maths::ShownFriction shown_by(double telling, double spread) {
  const maths::SlipEvidence evidence = {
      .plateau = {2, 1, 0, 0, spread}, .telling = telling, .agree = 1, .contradict = 0};
  return maths::shown_friction(&evidence, 1000);
}

TEST(ShownFriction, IsKnownBetterByTheNumberOfThoseThatShowIt) {
  EXPECT_FLOAT_EQ(shown_by(400, 0.02).friction, 2);
  EXPECT_NEAR(shown_by(400, 0.02).spread, PF_SPREAD_OF_SHOWN + 0.001, 1e-7);
  EXPECT_LT(shown_by(900, 0.02).spread, shown_by(400, 0.02).spread);
  EXPECT_LT(shown_by(400, 0.01).spread, shown_by(400, 0.02).spread);
  EXPECT_NEAR(shown_by(400, 0).spread, PF_SPREAD_OF_SHOWN, 1e-7);
  EXPECT_EQ(shown_by(100, 0.02).friction, 0);
}

}  // namespace
}  // namespace pillarfield
