// What was wanted of the field estimator, and whether it is met.

#include <fmt/format.h>

#include <string>

#include "core/field_work.h"
#include "report/field/field_goals.h"
#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

constexpr const char* kIntroduction = R"(## Goals

What was wanted before anything was measured, on the judging scenes: RMS error of the vector force over the pillars of region 3, divided by that of
the paper's midpoint. A goal counts as met where *every* scene meets it; "pooled" takes all pillars of those scenes together. Scenes with fewer than
{enough} ambiguous pillars have no ratio: there are {few} of {all}. "Noise alone" is the ratio that remains where every pillar has the force that is *nearest to the
truth* of all that explain its readings: these are noisy.

)";

std::string verdict_of(bool met) { return met ? "met" : "**not met**"; }

std::string goals_table(const std::vector<FieldGoal>& goals) {
  Table table("lrrrrrrl", {"Goal", "wanted", "pooled", "noise alone", "worst scene", "scenes",
                           "of these above", ""});
  for (const FieldGoal& goal : goals) {
    table.add({goal.what, fmt::format("≤ {:g}", goal.limit), ratio_text(goal.pooled),
               fmt::format("{:.3f}", goal.pooled.best_ratio()), fmt::format("{:.3f}", goal.worst),
               fmt::format("{}", goal.scenes), fmt::format("{}", goal.missed),
               verdict_of(goal.is_met())});
  }
  return table.text();
}

std::string text_of_missed(const FieldGoal& goal) {
  if (goal.missed == 0) return "";
  std::string text = fmt::format("- **{}, ≤ {:g}.** Worst: {} ({:.3f}). Above: {}.", goal.what,
                                 goal.limit, goal.worst_scene, goal.worst, goal.misses);
  if (goal.by_noise > 0) {
    text += fmt::format(
        " In {} of these {} scenes noise alone is above the limit: no force that explains the "
        "readings could meet it.",
        goal.by_noise, goal.missed);
  }
  if (goal.left > 0) {
    text += fmt::format(" In {} the evidence does not suffice, and most pillars keep the midpoint",
                        goal.left);
    if (goal.unasked > 0) {
      text += fmt::format(
          "; {} of them have less than one open pillar in {}, at the contact's edge, and are "
          "[not asked](decisions/field_estimator.md): the midpoint errs by {:.1f} counts there at "
          "most",
          goal.unasked, kLeastOpenShare, goal.most_unasked_counts);
    }
    text += ".";
  }
  if (goal.otherwise > 0) {
    text += fmt::format(" In {} the error is up to {:.2f} times that of noise alone.",
                        goal.otherwise, goal.most_over_noise);
  }
  return text + "\n";
}

std::string text_of_coverage(const CoverageGoal& goal) {
  const bool met = goal.below == 0 && goal.above == 0;
  const double share_of_resolved =
      100.0 * static_cast<double>(goal.resolved_below) / static_cast<double>(goal.resolved);
  return fmt::format(
      "\nThe truth shall lie in the stated 95 % band for 93 to 99 % of the pillars of region 3, in "
      "every judging scene: {}. Of {} scenes {} are below and {} above; the least is {:.1f} % "
      "({}), "
      "the largest {:.1f} %. Two things stop it. An error is *common* to a contact, that of its "
      "friction or of its model, and the band is one factor for all pillars: it holds nearly all "
      "of them or few, so that 95 % can be true of contacts, not of each: of the {} contacts that "
      "are resolved it holds less than 93 % in {}, {:.1f} %. And where nothing resolves a pillar, "
      "the whole segment is all that can be said, and holds nearly every truth: {} of those above. "
      "A narrower band could not be true there, since bodies that read the same reach "
      "from one end of it to the other ([below](#what-cannot-be-known)). Of those below, {} "
      "are within two standard deviations of 95 %, for they have few pillars "
      "([coverage](#coverage)).\n",
      verdict_of(met), goal.scenes, goal.below, goal.above, 100 * goal.least, goal.least_scene,
      100 * goal.most, goal.resolved, goal.resolved_below, share_of_resolved, goal.whole,
      goal.by_chance);
}

std::string text_of_rest(const FieldContext& context) {
  std::size_t touched = 0;
  for (const SceneResult& result : context.judging) touched += result.field().touched;
  return fmt::format(
      "\nPillars of regions 1 and 2 that differ from the direct solve in any bit: {}. On a square "
      "metre ([square_metre.toml](../scenes/square_metre.toml), {:.1f} % of the pillars in "
      "contact) the "
      "field solve at its default takes {:.2f} times as long as the direct one, and {:.2f} times "
      "with its contacts found and followed (wanted: ≤ 2), both in turns with it; in processor "
      "time, all threads together, {:.2f} and {:.2f} times. What bounds it is in "
      "[performance_decisions.md](performance_decisions.md#not-tried-or-not-done).\n",
      touched, 100 * context.times.square_metre_share, context.times.square_metre.time,
      context.times.square_metre_with_contacts.time, context.times.square_metre.processor,
      context.times.square_metre_with_contacts.processor);
}

}  // namespace

std::string field_goals_section(const FieldContext& context) {
  const auto goals = field_goals(context.judging);
  std::size_t few = 0;
  for (const SceneResult& result : context.judging) {
    if (!result.counts()) ++few;
  }
  std::string text = fmt::format(kIntroduction, fmt::arg("enough", kEnoughPillars),
                                 fmt::arg("few", few), fmt::arg("all", context.judging.size())) +
                     goals_table(goals);
  std::string missed;
  for (const FieldGoal& goal : goals) missed += text_of_missed(goal);
  if (!missed.empty()) text += "\nWhat stops those that are not met:\n\n" + missed;
  return text + text_of_coverage(coverage_goal(context.judging)) + text_of_rest(context);
}

}  // namespace pillarfield::report
