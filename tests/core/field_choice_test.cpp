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

  /// The model that is taken where each has a score, and their frictions a relative deviation of a
  /// tenth; PF_NO_MODEL where none is.
  [[nodiscard]] std::uint32_t taken(const std::vector<float>& scores, float known = 0) {
    maths::Choice choice{0, PF_NO_MODEL, 0, 0};
    choice.attempt = maths::attempt_from(0, choice, scratch_, known);
    tried_.clear();
    while (choice.attempt != PF_USE_BEST) {
      tried_.push_back(choice.attempt);
      if (maths::asks_flanks(choice)) {
        choice.attempt = maths::attempt_after_flanks(
            maths::verdict_by_flanks(flanks_, contradicted_), scratch_, &choice);
        continue;
      }
      maths::Verdict said = verdict(scores.at(maths::tried_number(choice)));
      said.spread = 0.1F;
      choice.attempt = maths::attempt_after(said, scratch_, known, &choice);
    }
    return choice.best;
  }

  std::vector<double> shared_;
  maths::Scratch scratch_{};
  std::vector<std::uint32_t> tried_;
  maths::FlankVerdict flanks_{2, 1, 0};  ///< nothing
  double contradicted_ = 0;
};

TEST_F(ModelChoice, TheBestScoreIsTakenOfAllThatAreTried) {
  EXPECT_EQ(taken({0.2F, 0.4F, 0.6F, 0.3F}), 2U);
  EXPECT_EQ(tried_, (std::vector<std::uint32_t>{0, 1, 2, 3, PF_FLANKS}));
}

TEST_F(ModelChoice, OneIsBelievedFromATenth) { EXPECT_EQ(taken({0.09F, 0.11F, 0, 0}), 1U); }

TEST_F(ModelChoice, OneThatLeavesNothingOpenEndsTheSearch) {
  leave(1, 0.005, 0);
  EXPECT_EQ(taken({0.2F, 0.6F, 0.9F, 0.9F}), 1U);
  EXPECT_EQ(tried_, (std::vector<std::uint32_t>{0, 1}));
}

TEST_F(ModelChoice, WhereNoTrendIsBelievedAllAreTriedWithTheirMembranes) {
  EXPECT_EQ(taken({0, 0, 0, 0}), PF_NO_MODEL);
  EXPECT_EQ(tried_.size(), 2 * PF_MODELS + 1);
}

TEST_F(ModelChoice, FlanksAreTakenWhereNoTrendIsBelievedAndSpareTheMembranes) {
  flanks_ = {2, 0.005, 50};
  EXPECT_EQ(taken({0, 0, 0, 0}), PF_FLANKS);
  EXPECT_EQ(tried_.size(), PF_MODELS + 1);
}

TEST_F(ModelChoice, OfFlanksAndATrendTheSurerIsTaken) {
  flanks_ = {2, 0.09 / PF_FLANK_ERRORS, 50};
  EXPECT_EQ(taken({0.6F, 0, 0, 0}), PF_FLANKS);
  flanks_.error = 0.11 / PF_FLANK_ERRORS;
  EXPECT_EQ(taken({0.6F, 0, 0, 0}), 0U);
}

TEST_F(ModelChoice, FlanksThatAreNotGoodEnoughAreNot) {
  const maths::FlankVerdict good{2, 0.005, 50};
  const std::vector<maths::FlankVerdict> bad = {{2, 0.021, 50}, {4.1, 0.005, 50}, {2, 0.005, 5}};
  for (const maths::FlankVerdict& said : bad) {
    flanks_ = said;
    EXPECT_EQ(taken({0, 0, 0, 0}), PF_NO_MODEL);
  }
  flanks_ = good;
  contradicted_ = 0.11;
  EXPECT_EQ(taken({0, 0, 0, 0}), PF_NO_MODEL);
}

TEST_F(ModelChoice, AFrictionOfFlanksMustBeAboveWhatNoPillarContradicts) {
  const auto is_taken = [&](double friction, double deviation) {
    flanks_ = {friction, deviation / PF_FLANK_ERRORS, 50};
    return taken({0, 0, 0, 0}) == PF_FLANKS;
  };
  EXPECT_TRUE(is_taken(1.45, 0.01));
  EXPECT_FALSE(is_taken(1.40, 0.001));
  EXPECT_FALSE(is_taken(1.6, 0.08));
  EXPECT_TRUE(is_taken(2, 0.08));
}

TEST_F(ModelChoice, FlanksAreNotAskedWhereAFrictionIsKnownOrATrendLeavesNothingOpen) {
  flanks_ = {2, 0.001, 50};
  EXPECT_EQ(taken({0, 0, 0, 0}, 2), PF_NO_MODEL);
  EXPECT_EQ(tried_.size(), PF_MODELS);
  leave(0, 0.005, 0);
  EXPECT_EQ(taken({0.6F, 0, 0, 0}), 0U);
}

TEST_F(ModelChoice, OfFewResolvedPillarsFlanksAloneAreAsked) {
  shared_[PF_AT_RESOLVED] = 59;
  flanks_ = {2, 0.005, 50};
  EXPECT_EQ(taken({1, 1, 1, 1}), PF_FLANKS);
  EXPECT_EQ(tried_, (std::vector<std::uint32_t>{PF_FLANKS}));
}

TEST_F(ModelChoice, AModelWhoseScaleIsSurerIsPreferred) {
  leave(0, 0.02, 0.01);
  EXPECT_EQ(taken({0.6F, 0, 0.3F, 0}), 2U);
  EXPECT_EQ(taken({0.9F, 0, 0.3F, 0}), 0U);
}

TEST_F(ModelChoice, FewPillarsAreNotAskedForManyTerms) {
  shared_[PF_AT_RESOLVED] = 60;  // four for each term of degree 4
  EXPECT_EQ(taken({0.2F, 0.3F, 0.4F, 0.5F}), 3U);
  shared_[PF_AT_RESOLVED] = 59;
  shared_[PF_AT_LOADED] = 100;
  EXPECT_EQ(taken({0.2F, 0.3F, 0.4F, 0.5F}), 1U);
}

/// The verdict on a contact once the model that was chosen is relaxed, whose ratios share
/// `implied`; `known` is the friction that resolved pillars show, zero where they show none.
class LastVerdict : public ModelChoice {
 protected:
  [[nodiscard]] maths::Verdict of(double implied, float known, float shown_spread) const {
    maths::Course course{};
    maths::begin_course(&course);
    course.choice = {PF_USE_BEST, 0, 0.5F, 0};
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
