// What the field estimator decides to do, by status bytes alone.

#include "core/field_work.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "pillarfield/status.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

SolverPlan plan_of(std::uint32_t rows, std::uint32_t cols) {
  SolverPlan plan;
  plan.skin.rows = 2 * rows;
  plan.skin.cols = 2 * cols;
  plan.estimator = Estimator::field;
  return plan;
}

constexpr std::uint8_t kOpen = status::kAmbiguous | status::kSensel1 | status::kSensel2;

/// All status bytes in one row, other pillars silent.
TEST(FieldWork, KnowsOpenPillarsByTheirStatus) {
  SolverPlan plan = plan_of(3, 300);
  plan.field.friction = 1;
  plan.field.slips = true;  // all stay alone
  FieldWork work(plan);
  std::vector<std::uint8_t> status(900);
  std::vector<std::uint32_t> open;
  for (std::uint32_t i = 0; i < 256; ++i) {
    status[310 + i] = static_cast<std::uint8_t>(i);
    if ((i & status::kUsable) != 0 && maths::is_open(static_cast<std::uint8_t>(i))) {
      open.push_back(310 + i);
    }
  }
  work.find(status);
  std::vector<std::uint32_t> alone = work.alone();
  std::sort(alone.begin(), alone.end());
  EXPECT_EQ(alone, open);
  EXPECT_GT(open.size(), 3U);
}

/// A contact is looked at where enough of its pillars are determined.
TEST(FieldWork, KnowsDeterminedPillarsByTheirStatus) {
  FieldWork work(plan_of(2, 20));
  for (unsigned bits = 1; bits < 256; ++bits) {
    if ((bits & status::kUsable) == 0) continue;
    std::vector<std::uint8_t> status(40, kOpen);
    const auto some = static_cast<std::uint8_t>(bits);
    std::fill_n(status.begin() + 20, 12, some);
    work.find(status);
    EXPECT_EQ(work.tiles().size(), maths::is_determined(some) ? 1U : 0U) << bits;
    status[25] = kOpen;
    work.find(status);
    EXPECT_TRUE(work.tiles().empty()) << "eleven are too few";
  }
}

/// Longer than what is counted at once.
TEST(FieldWork, CountsLongRuns) {
  constexpr std::uint32_t kCols = 5003;
  FieldWork work(plan_of(1, kCols));
  for (const std::uint32_t open : {77U, 78U, 79U}) {  // a pillar in 64
    std::vector<std::uint8_t> status(kCols, status::kUsable);
    std::fill_n(status.end() - open, open, kOpen);
    work.find(status);
    EXPECT_EQ(work.tiles().size(), open < 79 ? 0U : 1U);
    EXPECT_EQ(work.alone().size(), open < 79 ? open : 0U);
  }
}

}  // namespace
}  // namespace pillarfield
