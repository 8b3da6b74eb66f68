#include "pillarfield/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// A row of pillars that all press with 1 N from theta = 0.5 and phi = 3, in region 1, with
/// deviations of 0.1 N and ends that meet in the truth.
ForceField certain(std::uint32_t pillars) {
  ForceField field(1, pillars);
  field.shear_x.assign(pillars, static_cast<float>(-std::sin(0.5) * std::cos(3.0)));
  field.shear_y.assign(pillars, static_cast<float>(-std::sin(0.5) * std::sin(3.0)));
  field.normal.assign(pillars, static_cast<float>(std::cos(0.5)));
  field.status.assign(pillars, status::kUsable);
  for (auto& plane : field.uncertainty) plane.assign(pillars, 0.1F);
  const auto set = [&](Uncertainty plane, double value) {
    field.uncertainty[plane].assign(pillars, static_cast<float>(value));
  };
  set(Uncertainty::theta_low, 0.5);
  set(Uncertainty::theta_high, 0.5);
  set(Uncertainty::phi_low, 3);
  set(Uncertainty::phi_high, 3);
  set(Uncertainty::magnitude_low, 1);
  set(Uncertainty::magnitude_high, 1);
  return field;
}

RegionCoverage cover(const ForceField& solved, const ForceField& truth,
                     Region region = Region::one) {
  Coverage coverage;
  coverage.add(solved.view(), truth.view());
  return coverage.region(region);
}

TEST(Coverage, BandsEndAt1Point96Deviations) {
  const ForceField truth = certain(4);
  ForceField solved = truth;
  solved.shear_x[0] += 0.195F;
  solved.shear_x[1] -= 0.197F;
  solved.shear_y[2] += 0.197F;
  solved.normal[3] -= 0.195F;
  const RegionCoverage found = cover(solved, truth);
  EXPECT_EQ(found.pillars, 4);
  EXPECT_EQ(found.shear_x, 0.75);
  EXPECT_EQ(found.shear_y, 0.75);
  EXPECT_EQ(found.normal, 1);
  EXPECT_EQ(found.ends, 1);
}

TEST(Coverage, EndsAreWidenedByThreeDeviations) {
  const ForceField truth = certain(2);
  const double slack = 3 * std::sqrt(3.0) * 0.1;
  const auto share_with = [&](Uncertainty low, Uncertainty high, double width) {
    ForceField solved = truth;
    solved.uncertainty[low][0] += static_cast<float>(0.999 * width);
    solved.uncertainty[high][0] += static_cast<float>(0.999 * width);
    solved.uncertainty[low][1] += static_cast<float>(1.001 * width);
    solved.uncertainty[high][1] += static_cast<float>(1.001 * width);
    return cover(solved, truth).ends;
  };
  EXPECT_EQ(share_with(Uncertainty::magnitude_low, Uncertainty::magnitude_high, slack), 0.5);
  EXPECT_EQ(share_with(Uncertainty::theta_low, Uncertainty::theta_high, slack), 0.5);
  EXPECT_EQ(share_with(Uncertainty::phi_low, Uncertainty::phi_high, slack / std::sin(0.5)), 0.5);
}

TEST(Coverage, PhiRunsCounterClockwiseAcrossTheCut) {
  const ForceField truth = certain(1);
  ForceField solved = truth;
  for (const auto plane : {Uncertainty::shear_x, Uncertainty::shear_y, Uncertainty::normal}) {
    solved.uncertainty[plane][0] = 1e-6F;
  }
  const auto holds = [&](float low, float high) {
    solved.uncertainty[Uncertainty::phi_low][0] = low;
    solved.uncertainty[Uncertainty::phi_high][0] = high;
    return cover(solved, truth).ends == 1;
  };
  EXPECT_TRUE(holds(2.9F, -3.0F));
  EXPECT_TRUE(holds(2.9F, 3.1F));
  EXPECT_FALSE(holds(3.1F, 2.9F));
  EXPECT_FALSE(holds(-3.0F, 2.9F));
  EXPECT_TRUE(holds(-static_cast<float>(std::numbers::pi), static_cast<float>(std::numbers::pi)));
}

TEST(Coverage, NothingIsClaimedOfFlaggedPillars) {
  const ForceField truth = certain(3);
  ForceField solved = truth;
  solved.status[0] |= status::kSaturated;
  solved.status[1] |= status::kInconsistent;
  EXPECT_EQ(cover(solved, truth).pillars, 1);
  EXPECT_EQ(cover(solved, truth, Region::two).pillars, 0);
}

TEST(Coverage, RefusesFieldsThatDoNotFit) {
  Coverage coverage;
  ForceField bare = certain(3);
  for (auto& plane : bare.uncertainty) plane.clear();
  EXPECT_THROW(coverage.add(bare.view(), certain(3).view()), Error);
  EXPECT_THROW(coverage.add(certain(3).view(), certain(2).view()), Error);
}

}  // namespace
}  // namespace pillarfield
