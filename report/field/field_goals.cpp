#include "report/field/field_goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/field_work.h"

namespace pillarfield::report {
namespace {

using field_study::Family;
using field_study::kFrictionTold;
using field_study::kNothingSaid;
using field_study::kSlipTold;
using field_study::Motion;
using field_study::Scene;
using field_study::Shape;

/// What the goals call rounded; a cylinder's ends are abrupt.
bool is_round(const Scene& scene) {
  return scene.family() == Family::rounded && scene.contact.body.shape != Shape::cylinder;
}

struct Rule {
  const char* what;
  double limit;
  std::size_t method;  ///< of field_study::methods()
  bool (*holds)(const SceneResult& result);
};

constexpr double kResolvedShare = 0.1;

bool is_slide(const SceneResult& result) { return result.scene.motion() == Motion::slide; }

bool sticks_in_part(const SceneResult& result) {
  const Motion motion = result.scene.motion();
  return motion == Motion::partial_slip || motion == Motion::partial_turn || motion == Motion::roll;
}

constexpr std::array kRules = {
    Rule{"Rounded contacts in spin", 0.1, kNothingSaid,
         [](const SceneResult& result) {
           return is_round(result.scene) && result.scene.motion() == Motion::spin;
         }},
    Rule{"Rounded contacts in partial slip or rolling, a tenth or more of the contact determined",
         0.3, kNothingSaid,
         [](const SceneResult& result) {
           return is_round(result.scene) && sticks_in_part(result) &&
                  result.settled_share() >= kResolvedShare;
         }},
    Rule{"Cones in spin", 0.3, kNothingSaid,
         [](const SceneResult& result) {
           return result.scene.family() == Family::cone && result.scene.motion() == Motion::spin;
         }},
    Rule{"Uniform slide, the true friction told", 0.7, kFrictionTold, is_slide},
    Rule{"Uniform slide, the true friction told and that it slips", 0.1, kSlipTold, is_slide},
    Rule{"Every scene, nothing said", 1.02, kNothingSaid, [](const SceneResult&) { return true; }},
};

/// "cone 6 of 12, sphere 1 of 40".
std::string misses_by_shape(
    const std::map<std::string, std::pair<std::size_t, std::size_t>>& by_shape) {
  std::vector<std::string> parts;
  for (const auto& [name, counts] : by_shape) {
    if (counts.first == 0) continue;
    parts.push_back(fmt::format("{} {} of {}", name, counts.first, counts.second));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Why a scene misses a goal.
void add_miss(const SceneResult& result, const field_study::Score& score, FieldGoal& goal) {
  ++goal.missed;
  if (result.best.rms_counts() > goal.limit * result.theta.rms_counts()) {
    ++goal.by_noise;
  } else if (2 * score.resolved < score.open) {
    ++goal.left;
    if (kLeastOpenShare * score.open < score.loaded) {
      ++goal.unasked;
      goal.most_unasked_counts = std::max(goal.most_unasked_counts, result.theta.rms_counts());
    }
  } else {
    ++goal.otherwise;
    goal.most_over_noise =
        std::max(goal.most_over_noise, score.rms_counts() / result.best.rms_counts());
  }
}

FieldGoal goal_of(const Rule& rule, const std::vector<SceneResult>& judging) {
  FieldGoal goal;
  goal.what = rule.what;
  goal.limit = rule.limit;
  std::map<std::string, std::pair<std::size_t, std::size_t>> by_shape;
  for (const SceneResult& result : judging) {
    if (!result.counts() || !rule.holds(result) || !result.by_method[rule.method]) continue;
    const double ratio = result.ratio(rule.method);
    auto& [missed, all] = by_shape[name_of(result.scene.contact.body.shape)];
    goal.pooled.add(result, *result.by_method[rule.method]);
    ++goal.scenes;
    ++all;
    if (ratio > goal.worst) {
      goal.worst = ratio;
      goal.worst_scene = result.scene.name();
    }
    if (ratio <= rule.limit) continue;
    ++missed;
    add_miss(result, *result.by_method[rule.method], goal);
  }
  goal.misses = misses_by_shape(by_shape);
  return goal;
}

}  // namespace

std::vector<FieldGoal> field_goals(const std::vector<SceneResult>& judging) {
  std::vector<FieldGoal> goals;
  goals.reserve(kRules.size());
  for (const Rule& rule : kRules) goals.push_back(goal_of(rule, judging));
  return goals;
}

CoverageGoal coverage_goal(const std::vector<SceneResult>& judging) {
  CoverageGoal goal;
  for (const SceneResult& result : judging) {
    if (!result.counts()) continue;
    const double share = result.field().coverage();
    ++goal.scenes;
    goal.most = std::max(goal.most, share);
    const field_study::Score& score = result.field();
    const bool resolved = 2 * score.resolved >= score.open;
    if (resolved) ++goal.resolved;
    if (share < 0.93) {
      ++goal.below;
      if (resolved) ++goal.resolved_below;
      const double chance = std::sqrt(0.95 * 0.05 / static_cast<double>(score.open));
      if (share >= 0.95 - 1.96 * chance) ++goal.by_chance;
    }
    if (share > 0.99) {
      ++goal.above;
      if (!resolved) ++goal.whole;
    }
    if (share >= goal.least) continue;
    goal.least = share;
    goal.least_scene = result.scene.name();
  }
  return goal;
}

}  // namespace pillarfield::report
