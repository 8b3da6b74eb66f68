// Which models of a contact's pressure are tried, which are believed, and which is taken.

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/pillar_maths.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

/// What the fits of the models left in shared memory, of a contact half of which is resolved.
class ModelChoice : public testing::Test {
 protected:
  ModelChoice() : shared_(PF_SHARED_SUMS) {
    scratch_.shared = shared_.data();
    shared_[PF_AT_RESOLVED] = 500;
    shared_[PF_AT_LOADED] = 1000;
    for (std::uint32_t model = 0; model < PF_MODELS; ++model) leave(model, 0.02, 0);
  }

  void leave(std::uint32_t model, double unexplained, double scale_error) {
    const auto at = static_cast<std::size_t>(maths::model_of(model).shared);
    shared_[at + PF_TREND_UNEXPLAINED] = unexplained;
    shared_[at + PF_TREND_SCALE_ERROR] = scale_error;
  }

  [[nodiscard]] static maths::Verdict verdict(float score) {
    maths::Verdict made = maths::verdict_by(PF_BY_SHAPE, 2);
    made.score = score;
    return made;
  }

  [[nodiscard]] bool is_believed(std::uint32_t model, float score) const {
    return maths::is_believed(verdict(score), scratch_, maths::model_of(model), 0);
  }

  /// The model that is taken where each has a score; PF_MODELS where none is.
  [[nodiscard]] std::uint32_t taken(const std::vector<float>& scores) {
    maths::Choice choice{maths::attempt_from(0, {0, PF_MODELS, 0}, scratch_, 0), PF_MODELS, 0};
    tried_.clear();
    while (choice.attempt != PF_USE_BEST) {
      tried_.push_back(choice.attempt);
      choice.attempt = maths::attempt_after(verdict(scores.at(choice.attempt % PF_MODELS)),
                                            scratch_, 0, &choice);
    }
    return choice.best;
  }

  std::vector<double> shared_;
  maths::Scratch scratch_{};
  std::vector<std::uint32_t> tried_;
};

TEST_F(ModelChoice, TheBestScoreIsTakenOfAllThatAreTried) {
  EXPECT_EQ(taken({0.2F, 0.4F, 0.6F, 0.3F, 0.5F}), 2U);
  EXPECT_EQ(tried_, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
}

TEST_F(ModelChoice, OneThatLeavesNothingOpenEndsTheSearch) {
  leave(1, 0.005, 0);
  EXPECT_EQ(taken({0.2F, 0.6F, 0.9F, 0.9F, 0.9F}), 1U);
  EXPECT_EQ(tried_, (std::vector<std::uint32_t>{0, 1}));
}

TEST_F(ModelChoice, WhereNoTrendIsBelievedAllAreTriedWithTheirMembranes) {
  EXPECT_EQ(taken({0, 0, 0, 0, 0}), PF_MODELS);
  EXPECT_EQ(tried_.size(), 2 * PF_MODELS);
}

TEST_F(ModelChoice, AModelWhoseScaleIsSurerIsPreferred) {
  leave(0, 0.02, 0.01);
  EXPECT_EQ(taken({0.6F, 0, 0.3F, 0, 0}), 2U);
  EXPECT_EQ(taken({0.9F, 0, 0.3F, 0, 0}), 0U);
}

TEST_F(ModelChoice, OfDegreeSixLittleMayStayUnexplained) {
  EXPECT_EQ(maths::model_of(4).degree, 6U);
  for (const std::uint32_t model : {0U, 2U, 4U}) {
    leave(model, 0.04, 0);
    EXPECT_EQ(is_believed(model, 0.5F), model != 4) << model;
    leave(model, 0.025, 0);
    EXPECT_TRUE(is_believed(model, 0.5F)) << model;
    EXPECT_FALSE(is_believed(model, 0.05F)) << model;
  }
}

TEST_F(ModelChoice, FewPillarsAreNotAskedForManyTerms) {
  shared_[PF_AT_RESOLVED] = 60;  // four for each term of degree 4
  EXPECT_EQ(taken({0.2F, 0.3F, 0.4F, 0.5F, 0.6F}), 3U);
  shared_[PF_AT_RESOLVED] = 59;
  shared_[PF_AT_LOADED] = 100;
  EXPECT_EQ(taken({0.2F, 0.3F, 0.4F, 0.5F, 0.6F}), 1U);
}

/// The verdict on a contact once the model that was chosen is relaxed, whose ratios share
/// `implied`; `known` is the friction that resolved pillars show, zero where they show none.
class LastVerdict : public ModelChoice {
 protected:
  [[nodiscard]] maths::Verdict of(double implied, float known, float shown_spread) const {
    maths::Course course{};
    maths::begin_course(&course);
    course.choice = {PF_USE_BEST, 0, 0.5F};
    course.implied.ratio = implied;
    course.implied.share = 0.9;
    course.known = known;
    course.verdict.spread = shown_spread;
    maths::after_attempt(&course, scratch_);
    EXPECT_EQ(course.step, PF_END_OF_COURSE);
    return course.verdict;
  }
};

TEST_F(LastVerdict, IsTheModelsWhereNothingElseShowsTheFriction) {
  const maths::Verdict verdict = of(1.9, 0, 0);
  EXPECT_EQ(verdict.way, PF_BY_SHAPE);
  EXPECT_FLOAT_EQ(verdict.friction, 1.9F);
  EXPECT_EQ(verdict.may_stick, 0U);
}

TEST_F(LastVerdict, KeepsTheFrictionThatIsShownAndThatWhatSlipsMayStick) {
  const maths::Verdict verdict = of(1.9, 2, 0.004F);
  EXPECT_EQ(verdict.way, PF_BY_SHAPE);
  EXPECT_FLOAT_EQ(verdict.friction, 2);
  EXPECT_FLOAT_EQ(verdict.spread, 0.004F);
  EXPECT_EQ(verdict.may_stick, 1U);
}

}  // namespace
}  // namespace pillarfield
