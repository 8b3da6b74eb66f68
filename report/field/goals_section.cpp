// What was wanted of the estimator `contact`, and whether it is met.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

using field_study::kIntervals;
using field_study::Score;

constexpr const char* kIntroduction = R"(## Goals

RMS error of the force vector over the pillars of region 3 of the [histories](#recordings), in counts (newtons times counts per newton), all pillars of a friction taken together. "Friction given" is the error of `contact` where it is
given the true friction, "noise alone" that of the nearest force to the truth among those that explain the readings: they show what bounds a goal that is not met.

)";

/// The largest error that is wanted at a friction, counts.
struct ErrorGoal {
  double friction;
  double limit;
};
constexpr std::array kContactGoals = {ErrorGoal{0.8, 0.8}, ErrorGoal{1.2, 1.3}, ErrorGoal{1.6, 2.0},
                                      ErrorGoal{2.2, 3.0}, ErrorGoal{3.0, 4.6}};
constexpr std::array kDirectGoals = {ErrorGoal{1.2, 4.0}, ErrorGoal{1.6, 5.5}, ErrorGoal{2.2, 5.0},
                                     ErrorGoal{3.0, 8.0}};
constexpr double kUnrelatedFactor = 1.6;  // of the limits of related frames
constexpr double kWorstToPaper = 1.02;

std::string verdict_of(bool met) { return met ? "met" : "**not met**"; }

/// One row of the table of goals.
void add_error_goal(const FieldContext& context, std::size_t method, const ErrorGoal& goal,
                    Table& table) {
  const auto holds = of_friction(goal.friction);
  const Score found = pooled(context.histories, method, holds);
  table.add({fmt::format("{}, friction {:.1f}", methods()[method].name, goal.friction),
             fmt::format("≤ {:.2f}", goal.limit), rms_text(found),
             verdict_of(found.rms_counts() <= goal.limit),
             rms_text(pooled(context.histories, kGiven, holds)),
             rms_text(pooled_nearest(context.histories, holds))});
}

void add_error_goals(const FieldContext& context, Table& table) {
  for (const ErrorGoal& goal : kContactGoals) add_error_goal(context, kContact, goal, table);
  for (const ErrorGoal& goal : kContactGoals) {
    add_error_goal(context, kUnrelated, {goal.friction, kUnrelatedFactor * goal.limit}, table);
  }
  for (const ErrorGoal& goal : kDirectGoals) add_error_goal(context, kDirect, goal, table);
}

/// Histories up to the largest usual friction in which `contact` is worse than the paper.
std::vector<HistoryResult> worse_than_paper(const FieldContext& context) {
  std::vector<HistoryResult> worse;
  for (const HistoryResult& result : context.histories) {
    if (result.history.friction <= kLargestUsual && result.to_paper(kContact) > kWorstToPaper) {
      worse.push_back(result);
    }
  }
  std::sort(worse.begin(), worse.end(), [](const HistoryResult& a, const HistoryResult& b) {
    return a.to_paper(kContact) > b.to_paper(kContact);
  });
  return worse;
}

void add_paper_goal(const FieldContext& context, Table& table) {
  const auto usual = std::count_if(
      context.histories.begin(), context.histories.end(), [](const HistoryResult& result) {
        return result.history.friction <= kLargestUsual && result.open() > 0;
      });
  const std::size_t worse = worse_than_paper(context).size();
  table.add({fmt::format("recordings above {} of `paper`, friction up to {:g}", kWorstToPaper,
                         kLargestUsual),
             "none", fmt::format("{} of {}", worse, usual), verdict_of(worse == 0), "", ""});
}

void add_total_goals(const FieldContext& context, Table& table) {
  constexpr double kFriction = 2.2;
  constexpr double kMostBias = 0.02;
  constexpr double kMostRms = 0.04;
  const Score found = pooled(context.histories, kContact, of_friction(kFriction));
  const Score given = pooled(context.histories, kGiven, of_friction(kFriction));
  const auto signed_percent = [](double share) { return fmt::format("{:+.1f}", 100 * share); };
  table.add({fmt::format("total normal force, friction {:g}, bias, %", kFriction), "−2 to 2",
             signed_percent(found.total_bias()),
             verdict_of(std::abs(found.total_bias()) <= kMostBias),
             signed_percent(given.total_bias()), ""});
  table.add({fmt::format("total normal force, friction {:g}, RMS, %", kFriction), "≤ 4",
             percent_text(found.total_rms()), verdict_of(found.total_rms() <= kMostRms),
             percent_text(given.total_rms()), ""});
}

/// The range of a share over the intervals, and whether all lie within limits.
struct ShareRange {
  double low = 1;
  double high = 0;

  void add(double share) {
    low = std::min(low, share);
    high = std::max(high, share);
  }
  [[nodiscard]] bool within(double least, double most) const {
    return low >= least && high <= most;
  }
  [[nodiscard]] std::string text() const {
    return fmt::format("{} to {}", percent_text(low), percent_text(high));
  }
};

void add_coverage_goals(const FieldContext& context, Table& table) {
  ShareRange all;
  ShareRange recordings;
  const Score sum = pooled(context.histories, kContact, [](const HistoryResult&) { return true; });
  for (std::size_t interval = 0; interval < kIntervals; ++interval) {
    all.add(sum.coverage(interval));
    recordings.add(share_of_true_recordings(context.histories, interval));
  }
  table.add({"stated 95 % that hold the truth, by component, pooled, %", "93 to 99", all.text(),
             verdict_of(all.within(0.93, 0.99)), "", ""});
  table.add(
      {fmt::format("recordings of {} pillars or more in which 88 to 100 % do, %", kEnoughPillars),
       "≥ 90", recordings.text(), verdict_of(recordings.low >= 0.9), "", ""});
}

void add_closed_form_goals(const FieldContext& context, Table& table) {
  const auto add = [&](std::size_t index, double limit) {
    const Kind& kind = kinds()[index];
    const auto holds = [&](const ClosedFormResult& result) { return kind.holds(result.scene); };
    const double paper = pooled(context.closed_forms, kPaper, holds).rms_counts();
    const auto text = [&](const Score& score) {
      return fmt::format("{:.3f}", score.rms_counts() / paper);
    };
    const Score found = pooled(context.closed_forms, kContact, holds);
    table.add({fmt::format("closed forms, {}, ratio to `paper`", kind.name),
               fmt::format("≤ {:.2f}", limit), text(found),
               verdict_of(found.rms_counts() / paper <= limit),
               text(pooled(context.closed_forms, kGiven, holds)),
               text(pooled_nearest(context.closed_forms, holds))});
  };
  add(0, 0.03);
  add(1, 0.10);
}

std::string text_of_worse(const FieldContext& context) {
  const auto worse = worse_than_paper(context);
  if (worse.empty()) return "";
  Table table("lrrrr", {"recording worse than `paper`", "pillars of region 3", "of the loaded, %",
                        "`contact` over `paper`", "friction given, over `paper`"});
  for (const HistoryResult& result : worse) {
    const double open = static_cast<double>(result.open());
    table.add({result.history.name(), fmt::format("{}", result.open()),
               percent_text(open / static_cast<double>(result.nearest.loaded)),
               fmt::format("{:.2f}", result.to_paper(kContact)),
               fmt::format("{:.2f}", result.to_paper(kGiven))});
  }
  return "\nThe readings of these recordings say too little of the friction, and the prior expects "
         "a "
         "smaller one:\n\n" +
         table.text();
}

}  // namespace

std::string field_goals_section(const FieldContext& context) {
  Table table("lrrlrr", {"Goal", "wanted", "found", "", "friction given", "noise alone"});
  add_error_goals(context, table);
  add_paper_goal(context, table);
  add_total_goals(context, table);
  add_coverage_goals(context, table);
  add_closed_form_goals(context, table);
  return kIntroduction + table.text() + text_of_worse(context);
}

}  // namespace pillarfield::report
