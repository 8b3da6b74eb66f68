// Force errors equal the Cramér–Rao bound for a correct solve and exceed it for a faulty one.

#include "bench/force_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pillarfield::bench {
namespace {

constexpr std::uint32_t kErrorSide = 160;  ///< about 12000 pillars with a bound: errors to 0.6 %

ForceError error_of(const SolveVariant& variant, const SolverPlan& plan,
                    const NoisyFrames& frames) {
  static const Device device = open_device();
  return measure_force_error(device, variant, plan, frames, 1);
}

ForceError error_of(const SolveVariant& variant) {
  const SolverPlan plan = plan_of(variant, kErrorSide);
  return error_of(variant, plan, NoisyFrames(plan, 1));
}

TEST(ForceError, OfTheDirectSolveIsTheBoundWithEveryStageAndType) {
  for (const SolveVariant& variant : solve_variants()) {
    if (variant.estimator != Estimator::direct) continue;
    const ForceError error = error_of(variant);
    EXPECT_NEAR(error.over_bound, 1, 0.025) << name_of(variant);
    EXPECT_GT(error.pillars, 8000U) << name_of(variant);
    EXPECT_GT(error.ambiguous, 0.2) << name_of(variant);
    EXPECT_GT(error.all_counts, error.counts) << name_of(variant);
  }
}

TEST(ForceError, OfThePaperIsAboveTheBound) {
  EXPECT_GT(error_of({.estimator = Estimator::paper}).over_bound, 1.04);
}

TEST(ForceError, GrowsByWhatTheConverterRounds) {
  const double rounded = error_of({.type = SenselType::u8}).counts;
  const double exact = error_of({.type = SenselType::f32}).counts;
  EXPECT_NEAR(rounded / exact, std::sqrt(1 + 1 / (12 * 0.25)), 0.02);
}

TEST(ForceError, IsTheSameInDouble) {
  const ForceError single = error_of({.stage = "all"});
  const ForceError twice = error_of({.arithmetic = Arithmetic::host_double, .stage = "all"});
  EXPECT_NEAR(single.over_bound, twice.over_bound, 1e-4);
  EXPECT_NEAR(single.all_counts, twice.all_counts, 1e-3 * twice.all_counts);
  EXPECT_NEAR(single.ambiguous, twice.ambiguous, 1e-3);
}

TEST(ForceError, SeesASolveThatIsOffByTwoPercent) {
  const SolveVariant variant;
  SolverPlan plan = plan_of(variant, kErrorSide);
  const NoisyFrames frames(plan, 1);
  plan.skin.counts_per_newton *= 1.02;
  EXPECT_GT(error_of(variant, plan, frames).over_bound, 1.2);
}

TEST(ForceError, SeesACalibrationThatIsNotUsed) {
  const SolverPlan known = plan_of({.stage = "calibration"}, kErrorSide);
  const SolveVariant bare;
  EXPECT_GT(error_of(bare, plan_of(bare, kErrorSide), NoisyFrames(known, 1)).over_bound, 2);
}

}  // namespace
}  // namespace pillarfield::bench
