// What was wanted of the estimator `contact`, and whether it is met.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

using field_study::Score;

constexpr const char* kIntroduction = R"(## Goals

RMS error of the force vector over the pillars of region 3 of the [histories](#recordings), in counts (newtons times counts per newton), all pillars of a friction taken together. "Friction given" is the error of `contact` where it is
given the true friction, "noise alone" that of the nearest force to the truth among those that explain the readings: they show what bounds a goal that is not met: "friction" where the goal would be met with the true friction given, "more than friction" where not. Coverage is given from the least to the most covered component, and recordings count from 30 pillars of region 3 on.

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

/// What a method has to do with a goal.
struct Found {
  std::string text;
  bool met = false;
  const char* bound = nullptr;  ///< what bounds it, where that is known otherwise
};

/// A row of the table. Where the goal is not met, `given`, with the true friction, tells why.
void add_goal(const std::string& what, const std::string& wanted, const Found& found,
              const Found& given, const std::string& noise, Table& table) {
  const char* const reason =
      found.bound != nullptr ? found.bound : (given.met ? "friction" : "more than friction");
  table.add({what, wanted, found.text, found.met ? "met" : "**not met**", given.text, noise,
             found.met ? "" : reason});
}

Found found_error(const Score& score, double limit) {
  return {rms_text(score), score.rms_counts() <= limit};
}

void add_error_goal(const FieldContext& context, std::size_t method, const ErrorGoal& goal,
                    Table& table) {
  const auto holds = of_friction(goal.friction);
  const Found given = found_error(pooled(context.histories, kGiven, holds), goal.limit);
  add_goal(fmt::format("{}, friction {:.1f}", methods()[method].name, goal.friction),
           fmt::format("≤ {:.2f}", goal.limit),
           found_error(pooled(context.histories, method, holds), goal.limit), given,
           rms_text(pooled_nearest(context.histories, holds)), table);
}

void add_error_goals(const FieldContext& context, Table& table) {
  for (const ErrorGoal& goal : kContactGoals) add_error_goal(context, kContact, goal, table);
  for (const ErrorGoal& goal : kContactGoals) {
    add_error_goal(context, kUnrelated, {goal.friction, kUnrelatedFactor * goal.limit}, table);
  }
  for (const ErrorGoal& goal : kDirectGoals) add_error_goal(context, kDirect, goal, table);
}

/// Histories up to the largest usual friction in which a method is worse than the paper.
std::vector<HistoryResult> worse_than_paper(const std::vector<HistoryResult>& usual,
                                            std::size_t method) {
  std::vector<HistoryResult> worse;
  std::copy_if(
      usual.begin(), usual.end(), std::back_inserter(worse),
      [=](const HistoryResult& result) { return result.to_paper(method) > kWorstToPaper; });
  std::sort(worse.begin(), worse.end(), [=](const HistoryResult& a, const HistoryResult& b) {
    return a.to_paper(method) > b.to_paper(method);
  });
  return worse;
}

std::vector<HistoryResult> usual_of(const FieldContext& context) {
  std::vector<HistoryResult> usual;
  std::copy_if(context.histories.begin(), context.histories.end(), std::back_inserter(usual),
               [](const HistoryResult& result) {
                 return result.history.friction <= kLargestUsual && result.open() > 0;
               });
  return usual;
}

void add_paper_goal(const std::vector<HistoryResult>& usual, Table& table) {
  const auto found = [&](std::size_t method) {
    const std::size_t worse = worse_than_paper(usual, method).size();
    return Found{fmt::format("{} of {}", worse, usual.size()), worse == 0};
  };
  add_goal(fmt::format("recordings above {} of `paper`, friction up to {:g}", kWorstToPaper,
                       kLargestUsual),
           "none", found(kContact), found(kGiven), "", table);
}

void add_total_goals(const FieldContext& context, Table& table) {
  constexpr double kFriction = 2.2;
  constexpr double kMostBias = 0.02;
  constexpr double kMostRms = 0.04;
  const auto bias = [&](std::size_t method) {
    const double share = pooled(context.histories, method, of_friction(kFriction)).total_bias();
    return Found{fmt::format("{:+.1f}", 100 * share), std::abs(share) <= kMostBias};
  };
  const auto rms = [&](std::size_t method) {
    const double share = pooled(context.histories, method, of_friction(kFriction)).total_rms();
    return Found{percent_text(share), share <= kMostRms};
  };
  add_goal(fmt::format("total normal force of a frame, friction {:g}, bias, %", kFriction),
           "−2 to 2", bias(kContact), bias(kGiven), "", table);
  add_goal(fmt::format("total normal force of a frame, friction {:g}, RMS, %", kFriction), "≤ 4",
           rms(kContact), rms(kGiven), "", table);
}

/// The histories in which the intervals of the components are to hold.
struct CoverageGoal {
  std::string what;
  const std::vector<HistoryResult>& results;
};

/// The least and the largest of the values of `share_of` for each interval.
template <class ShareOf>
Found found_shares(double least, double most, ShareOf share_of) {
  double low = 1;
  double high = 0;
  for (std::size_t interval = 0; interval < field_study::kFirstEnds; ++interval) {
    low = std::min(low, share_of(interval));
    high = std::max(high, share_of(interval));
  }
  return {fmt::format("{} to {}", percent_text(low), percent_text(high)),
          low >= least && high <= most};
}

void add_coverage_goal(const CoverageGoal& goal, Table& table) {
  const auto all = [&](std::size_t method) {
    const Score sum = pooled(goal.results, method, [](const HistoryResult&) { return true; });
    return found_shares(0.93, 0.99, [&](std::size_t i) { return sum.coverage(i); });
  };
  const auto recordings = [&](std::size_t method) {
    return found_shares(
        0.9, 1, [&](std::size_t i) { return share_of_true_recordings(goal.results, method, i); });
  };
  add_goal(fmt::format("stated 95 % hold the truth, {}, %", goal.what), "93 to 99", all(kContact),
           all(kGiven), "", table);
  add_goal(fmt::format("recordings in which 88 to 100 % do, {}, %", goal.what), "≥ 90",
           recordings(kContact), recordings(kGiven), "", table);
}

void add_coverage_goals(const FieldContext& context, const std::vector<HistoryResult>& usual,
                        Table& table) {
  add_coverage_goal({"components from low to high, friction up to 3", usual}, table);
  add_coverage_goal({"components from low to high, all frictions", context.histories}, table);
}

void add_closed_form_goal(const FieldContext& context, const Kind& kind, double limit,
                          Table& table) {
  const auto holds = [&](const ClosedFormResult& result) { return kind.holds(result.scene); };
  const double paper = pooled(context.closed_forms, kPaper, holds).rms_counts();
  const auto found = [&](const Score& score) {
    const double ratio = score.rms_counts() / paper;
    return Found{fmt::format("{:.3f}", ratio), ratio <= limit};
  };
  add_goal(fmt::format("closed forms, {}, ratio to `paper`", kind.name),
           fmt::format("≤ {:.2f}", limit), found(pooled(context.closed_forms, kContact, holds)),
           found(pooled(context.closed_forms, kGiven, holds)),
           found(pooled_nearest(context.closed_forms, holds)).text, table);
}

std::string text_of_direct(const FieldContext& context) {
  const auto text = [&](std::size_t method, double friction) {
    return rms_text(pooled(context.histories, method, of_friction(friction)));
  };
  return fmt::format(
      "\n`direct` puts the force at one point of every segment, and no point suits all frictions: "
      "at a segment point of 0.75 instead of 0.875 its error is {} instead of {} counts at "
      "friction "
      "3.0, but {} instead of {} at 1.6.\n",
      text(kLower, 3.0), text(kDirect, 3.0), text(kLower, 1.6), text(kDirect, 1.6));
}

std::string text_of_worse(const std::vector<HistoryResult>& usual) {
  const auto worse = worse_than_paper(usual, kContact);
  if (worse.empty()) return "";
  Table table("lrrrr", {"recording worse than `paper`", "pillars of region 3", "of the loaded, %",
                        "`contact` over `paper`", "friction given, over `paper`"});
  for (const HistoryResult& result : worse) {
    const auto open = static_cast<double>(result.open());
    table.add({result.history.name(), fmt::format("{}", result.open()),
               percent_text(open / static_cast<double>(result.nearest.loaded)),
               fmt::format("{:.2f}", result.to_paper(kContact)),
               fmt::format("{:.2f}", result.to_paper(kGiven))});
  }
  return "\nMost loaded pillars of these recordings are ambiguous, their friction is larger than "
         "the "
         "prior expects, and readings do not tell it:\n\n" +
         table.text();
}

}  // namespace

std::string field_goals_section(const FieldContext& context) {
  Table table("lrrlrrl",
              {"Goal", "wanted", "found", "", "friction given", "noise alone", "bounded by"});
  const std::vector<HistoryResult> usual = usual_of(context);
  add_error_goals(context, table);
  add_paper_goal(usual, table);
  add_total_goals(context, table);
  add_coverage_goals(context, usual, table);
  add_closed_form_goal(context, kinds()[0], 0.03, table);
  add_closed_form_goal(context, kinds()[1], 0.10, table);
  return kIntroduction + table.text() + text_of_direct(context) + text_of_worse(usual);
}

}  // namespace pillarfield::report
