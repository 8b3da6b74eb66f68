// The coverage of the stated uncertainty is as stated, on scenes with all imperfections that a
// calibration corrects.

#include "lab/studies/coverage_study.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace pillarfield::coverage_study {
namespace {

class StatedUncertainty : public testing::TestWithParam<std::size_t> {
 protected:
  StatedUncertainty() : parted_(cover(studies()[GetParam()].scene)) {}
  Parted parted_;
};

void expect_band_of_95_percent(const RegionCoverage& coverage) {
  EXPECT_GT(coverage.pillars, 3000U);
  for (const double share : {coverage.shear_x, coverage.shear_y, coverage.normal}) {
    EXPECT_GE(share, 0.93);
    EXPECT_LE(share, 0.97);
  }
}

TEST_P(StatedUncertainty, Holds95PercentOfTheTruthsInRegionsOneAndTwo) {
  for (const Region region : {Region::one, Region::two}) {
    SCOPED_TRACE(name_of(region));
    expect_band_of_95_percent(parted_.all.region(region));
    expect_band_of_95_percent(parted_.rightly_read.region(region));
  }
}

TEST_P(StatedUncertainty, HasEndsThatHoldTheTruthInRegionThree) {
  EXPECT_GT(parted_.all.region(Region::three).pillars, 500U);
  EXPECT_GE(parted_.all.region(Region::three).ends, 0.999);
  EXPECT_GE(parted_.rightly_read.region(Region::four).ends, 0.999);
}

TEST_P(StatedUncertainty, IsTooNarrowOnlyWhereASenselIsUsableByLuck) {
  // A sensel usable by luck reads too much; one inactive by bad luck leaves the estimate unbiased.
  for (const Region region : {Region::one, Region::two}) {
    const RegionCoverage lucky = parted_.by_luck.region(region);
    const RegionCoverage all = parted_.all.region(region);
    EXPECT_LT(static_cast<double>(lucky.pillars), 0.07 * static_cast<double>(all.pillars));
    EXPECT_LT(lucky.normal, 0.95);
    const RegionCoverage unlucky = parted_.by_bad_luck.region(region);
    if (unlucky.pillars < 300) continue;
    EXPECT_NEAR(unlucky.normal, 0.95, 0.03);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, StatedUncertainty, testing::Range(std::size_t{0}, studies().size()));

}  // namespace
}  // namespace pillarfield::coverage_study
