#include "contacts/estimator/friction_posterior.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contacts/estimator/friction_likelihood.h"

namespace pillarfield {
namespace {

constexpr double kNoCeiling = 1e3;

TEST(FrictionPosterior, BeginsWithTheLogNormalPrior) {
  FrictionKnowledge knowledge;
  knowledge.median = 1.4;
  knowledge.spread = 0.3;
  const FrictionPosterior posterior(knowledge);
  // Quantiles of a normal distribution: 16 and 84 % lie a deviation from the median.
  EXPECT_NEAR(posterior.quantile(0.5), 1.4, 0.01);
  EXPECT_NEAR(std::log(posterior.quantile(0.8413) / 1.4), 0.3, 0.005);
  EXPECT_NEAR(std::log(posterior.quantile(0.1587) / 1.4), -0.3, 0.005);
  EXPECT_NEAR(posterior.spread(), 0.3, 0.005);
}

TEST(FrictionPosterior, OfAGivenFrictionIsNarrow) {
  FrictionKnowledge knowledge;
  knowledge.given = 0.65;
  const FrictionPosterior posterior(knowledge);
  EXPECT_NEAR(posterior.quantile(0.5), 0.65, 0.005);
  EXPECT_NEAR(posterior.spread(), 0.03, 0.005);
}

TEST(FrictionPosterior, ExceedsNoBound) {
  for (const double bound : {0.1, 0.11, 0.5, 1.0, 4.0, 100.0}) {
    FrictionKnowledge knowledge;
    knowledge.bound = bound;
    EXPECT_LE(FrictionPosterior(knowledge).quantile(0.999), bound * 1.02) << bound;
  }
}

TEST(FrictionPosterior, OfALooseBoundIsThePrior) {
  FrictionKnowledge loose;
  loose.bound = 9;
  for (const double share : {0.1, 0.5, 0.9}) {
    EXPECT_NEAR(FrictionPosterior(loose).quantile(share),
                FrictionPosterior(FrictionKnowledge{}).quantile(share), 1e-3);
  }
}

TEST(FrictionPosterior, ForgetsTowardsThePrior) {
  FrictionKnowledge known;
  known.given = 2;
  const FrictionPosterior prior(FrictionKnowledge{});
  FrictionPosterior posterior(known);
  for (int frame = 0; frame < 400; ++frame) posterior = posterior.carried(prior, 0.05);
  EXPECT_NEAR(posterior.quantile(0.5), prior.quantile(0.5), 1e-3);
}

class Likelihood : public testing::Test {
 protected:
  static FrictionPosterior after(const std::vector<ObservedRatio>& ratios,
                                 const std::vector<ObservedRatio>& bounds = {}) {
    const FrictionLikelihood likelihood{ContactParameters{}};
    FrictionCurve logarithm{};
    likelihood.add_slip_or_stick(ratios, ContactParameters{}.effective_pillars, logarithm);
    likelihood.add_lower_bounds(bounds, ContactParameters{}.effective_pillars, logarithm);
    FrictionPosterior posterior{FrictionKnowledge{}};
    posterior.update(logarithm);
    return posterior;
  }
};

TEST_F(Likelihood, PillarsThatShareARatioSlip) {
  for (const double friction : {0.4, 0.9, 1.7, 3.0}) {
    const FrictionPosterior posterior =
        after(std::vector<ObservedRatio>(30, {friction, 0.03, kNoCeiling}));
    EXPECT_NEAR(posterior.quantile(0.5) / friction, 1, 0.02) << friction;
    EXPECT_LT(posterior.spread(), 0.03) << friction;
  }
}

TEST_F(Likelihood, TheLargestOfSpreadRatiosIsTheLeastFriction) {
  std::vector<ObservedRatio> ratios;
  for (int i = 1; i <= 60; ++i) ratios.push_back({0.02 * i, 0.03, kNoCeiling});
  EXPECT_GT(after(ratios).quantile(0.05), 1.05);
}

TEST_F(Likelihood, AFewOutliersDoNotRaiseTheFriction) {
  std::vector<ObservedRatio> ratios(40, {0.8, 0.03, kNoCeiling});
  ratios.push_back({2.5, 0.03, kNoCeiling});
  EXPECT_NEAR(after(ratios).quantile(0.5), 0.8, 0.03);
}

TEST_F(Likelihood, AmbiguousPillarsBoundItFromBelow) {
  const FrictionPosterior posterior = after({}, std::vector<ObservedRatio>(10, {1.8, 0.05, 0}));
  EXPECT_GT(posterior.quantile(0.05), 1.65);
}

/// The posterior's width does not fall with the number of pillars beyond effective_pillars.
TEST_F(Likelihood, ManyPillarsAreNotMoreCertainThanTheirEffectiveNumber) {
  const auto spread = [](std::size_t pillars) {
    return after(std::vector<ObservedRatio>(pillars, {1.0, 0.2, kNoCeiling})).spread();
  };
  EXPECT_NEAR(spread(4000), spread(40), 0.002);
  EXPECT_GT(spread(10), 1.5 * spread(40));
}

TEST_F(Likelihood, ExtremeRatiosLeaveAFinitePosterior) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double ratio : {0.0, 1e-30, 1e30, infinity, std::nan("")}) {
    const FrictionPosterior posterior =
        after(std::vector<ObservedRatio>(50, {ratio, 0.03, kNoCeiling}));
    EXPECT_TRUE(std::isfinite(posterior.quantile(0.5))) << ratio;
    EXPECT_TRUE(std::isfinite(posterior.spread())) << ratio;
  }
}

}  // namespace
}  // namespace pillarfield
