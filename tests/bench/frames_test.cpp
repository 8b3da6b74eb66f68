// Regions, contact and variety of the benchmark's frames.

#include "bench/frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "bench/variants.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"

namespace pillarfield::bench {
namespace {

std::vector<Region> regions_of(const SolverPlan& plan, const FrameView& frame) {
  std::vector<Region> regions;
  for (const std::uint8_t status : solve_on_host(plan, frame).status) {
    regions.push_back(region_of(status));
  }
  return regions;
}

class EveryType : public testing::TestWithParam<SenselType> {};

TEST_P(EveryType, WholeSkinIsInTheChosenRegion) {
  const SolverPlan plan = bare_plan(37, GetParam());
  const std::pair<Touch, Region> touches[] = {{Touch::one, Region::one},
                                              {Touch::two, Region::two},
                                              {Touch::three, Region::three},
                                              {Touch::four, Region::four},
                                              {Touch::idle, Region::none}};
  for (const auto& [touch, wanted] : touches) {
    const Frames frames(plan.skin, GetParam(), {touch, 1});
    const auto regions = regions_of(plan, frames[1]);
    EXPECT_EQ(std::ranges::count(regions, wanted), std::ssize(regions)) << name_of(wanted);
  }
}

TEST_P(EveryType, MixedFramesHaveAllRegionsAndNoIdlePillar) {
  const SolverPlan plan = bare_plan(64, GetParam());
  const Frames frames(plan.skin, GetParam(), {});
  const auto regions = regions_of(plan, frames[0]);
  for (const Region region : {Region::one, Region::two, Region::three}) {
    EXPECT_GT(std::ranges::count(regions, region), std::ssize(regions) / 20) << name_of(region);
  }
  EXPECT_GT(std::ranges::count(regions, Region::four), 0);
  EXPECT_EQ(std::ranges::count(regions, Region::none), 0);
  EXPECT_EQ(frames.contact(), 1);
}

TEST_P(EveryType, WorstFramesChangeRegionFromPillarToPillar) {
  const SolverPlan plan = bare_plan(40, GetParam());
  const Frames frames(plan.skin, GetParam(), {Touch::worst, 1});
  const auto regions = regions_of(plan, frames[0]);
  for (std::size_t i = 0; i + 1 < regions.size(); ++i) {
    if ((i + 1) % plan.skin.pillar_cols() == 0) continue;
    ASSERT_NE(regions[i], regions[i + 1]) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Types, EveryType,
                         testing::Values(SenselType::u8, SenselType::u16, SenselType::f32),
                         [](const auto& type) { return std::string(name_of(type.param)); });

TEST(Frames, AreDistinct) {
  const SolverPlan plan = bare_plan(32);
  const Frames frames(plan.skin, plan.sensel_type, {});
  ASSERT_EQ(frames.size(), 64U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      ASSERT_NE(std::memcmp(frames[i].data, frames[j].data, plan.skin.sensels()), 0);
    }
  }
  EXPECT_EQ(frames[64].data, frames[0].data);
}

TEST(Frames, ContactsCoverTheirFractionAndMove) {
  const SolverPlan plan = bare_plan(200);
  for (const double fraction : {0.01, 0.1, 0.3}) {
    const Frames frames(plan.skin, plan.sensel_type, {Touch::mixed, fraction});
    EXPECT_NEAR(frames.contact(), fraction, 0.1 * fraction);
    EXPECT_NE(std::memcmp(frames[0].data, frames[1].data, plan.skin.sensels()), 0);
  }
}

TEST(Frames, FitIntoAGibibyte) {
  const Frames frames(bare_plan(4000).skin, SenselType::f32, {Touch::idle, 1});
  EXPECT_EQ(frames.size(), 4U);  // of 4 * 8000 * 8000 bytes
}

}  // namespace
}  // namespace pillarfield::bench
