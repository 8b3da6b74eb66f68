// The goals of made-up runs: met, not met, not measured.

#include "report/speed/goals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "made_up_run.h"

namespace pillarfield::report {
namespace {

/// The goal whose text has these words.
Goal goal_about(const SpeedRun& run, const std::string& words) {
  const auto all = goals(run);
  const auto found = std::ranges::find_if(
      all, [&](const Goal& goal) { return goal.what.find(words) != std::string::npos; });
  if (found == all.end()) throw std::out_of_range(words);
  return *found;
}

SpeedRun run_of(const std::map<std::string, std::string>& rows) {
  return {made_up_run(rows), std::nullopt};
}

TEST(Goals, AreMetAtTheirLimitAndNotBelow) {
  const auto met = goal_about(run_of({{"size/1000000", R"("of_ceiling":0.95)"}}), "10⁶");
  EXPECT_TRUE(met.is_met());
  EXPECT_EQ(met.measured, 0.95);
  EXPECT_FALSE(goal_about(run_of({{"size/1000000", R"("of_ceiling":0.949)"}}), "10⁶").is_met());
}

TEST(Goals, OfTimesAreMetBelowTheirLimit) {
  const auto all_stages = [](const char* row) {
    return goal_about(run_of({{"stage/all", row}}), "All stages");
  };
  EXPECT_TRUE(all_stages(R"("of_ceiling":0.8)").is_met());
  EXPECT_DOUBLE_EQ(all_stages(R"("of_ceiling":0.8)").measured.value(), 1.25);
  EXPECT_FALSE(all_stages(R"("of_ceiling":0.75)").is_met());
}

TEST(Goals, WithoutARowAreNotMeasuredAndNotMet) {
  for (const Goal& goal : goals(run_of({{"lanes/1", R"("ns_per_pillar":1)"}}))) {
    EXPECT_FALSE(goal.measured.has_value()) << goal.what;
    EXPECT_FALSE(goal.is_met()) << goal.what;
  }
}

TEST(Goals, CompareWhatEachRaceHadForACopy) {
  // The second race met a machine half as fast.
  const SpeedRun run = run_of({{"contact/100/bare", R"("ns_per_pillar":1,"of_ceiling":0.8)"},
                               {"contact/1/bare", R"("ns_per_pillar":0.4,"of_ceiling":4)"}});
  EXPECT_DOUBLE_EQ(goal_about(run, "1 % in contact").measured.value(), 0.2);
  EXPECT_FALSE(
      goal_about(run_of({{"contact/1/bare", R"("of_ceiling":4)"}}), "1 % in contact").measured);
}

TEST(Goals, OfSizesTakeTheSlowestOverTheFastest) {
  const SpeedRun run = run_of({{"size/99856", R"("ns_per_pillar":0.5,"of_ceiling":1)"},
                               {"size/624100", R"("ns_per_pillar":0.6)"},
                               {"size/1000000", R"("ns_per_pillar":0.4,"of_ceiling":1)"},
                               {"size/9998244", R"("ns_per_pillar":0.5)"}});
  EXPECT_DOUBLE_EQ(goal_about(run, "10⁷").measured.value(), 1.5);
}

TEST(Goals, OfALiveRunCountMissedAndDropped) {
  SpeedRun run = run_of({});
  run.live = LiveRun{};
  EXPECT_TRUE(goal_about(run, "1 kHz").is_met());
  run.live->missed = 2;
  run.live->dropped = 3;
  EXPECT_EQ(goal_about(run, "1 kHz").measured, 5);
  EXPECT_FALSE(goal_about(run, "1 kHz").is_met());
}

TEST(GoalsTable, SaysMetNotMetAndNotMeasured) {
  const std::string table =
      goals_table({{"a", true, 1, 2.0}, {"b", false, 1, 2.0}, {"c", true, 1, {}}});
  EXPECT_NE(table.find("| a | ≥ 1 | 2 | met |"), std::string::npos) << table;
  EXPECT_NE(table.find("| b | ≤ 1 | 2 | **not met** |"), std::string::npos) << table;
  EXPECT_NE(table.find("| c | ≥ 1 | – | not measured |"), std::string::npos) << table;
}

}  // namespace
}  // namespace pillarfield::report
