#include "report/field/field_run.h"

#include <fmt/format.h>

namespace pillarfield::report {
namespace {

using field_study::Family;
using field_study::Method;
using field_study::Motion;
using field_study::Observed;
using field_study::Scene;
using field_study::Score;
using field_study::Shape;

double root_ratio(const Score& a, const Score& b) {
  return b.squares > 0 ? a.rms_counts() / b.rms_counts() : 0;
}

std::optional<Score> score_of(const Scene& scene, const Observed& observed, const Method& method) {
  const auto solved = field_study::solve(scene, observed, method);
  if (!solved) return std::nullopt;
  return observed.score(*solved);
}

bool has_goal(std::size_t method) {
  return method == field_study::kNothingSaid || method == field_study::kFrictionTold ||
         method == field_study::kSlipTold;
}

SceneResult result_of(const Scene& scene, bool all_methods) {
  const Observed observed(scene);
  SceneResult result;
  result.scene = scene;
  result.middle = observed.score(observed.direct());
  result.theta = observed.score(observed.theta_midpoint());
  result.best = observed.score(observed.nearest());
  const auto& methods = field_study::methods();
  const bool typical = scene.noise_counts == kTypicalNoise;
  result.by_method.resize(methods.size());
  for (std::size_t i = 0; i < (all_methods ? methods.size() : 1); ++i) {
    if (typical || has_goal(i)) result.by_method[i] = score_of(scene, observed, methods[i]);
  }
  if (!typical || !all_methods) return result;
  for (std::size_t i = 0; i < kSweeps.size(); ++i) {
    Method method = field_study::methods().front();
    method.evidence.sweeps = kSweeps[i];
    result.by_sweeps[i] = score_of(scene, observed, method);
  }
  return result;
}

bool is_cylinder(const Scene& scene) { return scene.contact.body.shape == Shape::cylinder; }

/// Round in every direction: a cylinder's ends are abrupt.
bool is_round(const Scene& scene) {
  return scene.family() == Family::rounded && !is_cylinder(scene);
}

bool is_partial(const Scene& scene) {
  return scene.motion() == Motion::partial_slip || scene.motion() == Motion::partial_turn;
}

Kind kind(const char* name, bool (*holds)(const Scene&)) { return {name, holds}; }

}  // namespace

double SceneResult::ratio(std::size_t method) const {
  return by_method[method] ? root_ratio(*by_method[method], theta) : 0;
}

double SceneResult::settled_share() const {
  if (theta.loaded == 0) return 0;
  return 1 - static_cast<double>(theta.open) / static_cast<double>(theta.loaded);
}

std::vector<SceneResult> results_of(const std::vector<Scene>& scenes, bool all_methods) {
  std::vector<SceneResult> results(scenes.size());
  field_study::for_each_index(
      scenes.size(), [&](std::size_t i) { results[i] = result_of(scenes[i], all_methods); });
  return results;
}

void Pooled::add(const SceneResult& result, const Score& score) {
  middle += result.middle;
  theta += result.theta;
  best += result.best;
  solved += score;
  ++scenes;
}

double Pooled::ratio() const { return root_ratio(solved, theta); }
double Pooled::best_ratio() const { return root_ratio(best, theta); }

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      kind("rounded, spin and turn",
           [](const Scene& scene) {
             return is_round(scene) &&
                    (scene.motion() == Motion::spin || scene.motion() == Motion::turn);
           }),
      kind("rounded, partial slip",
           [](const Scene& scene) { return is_round(scene) && is_partial(scene); }),
      kind("rounded, roll",
           [](const Scene& scene) { return is_round(scene) && scene.motion() == Motion::roll; }),
      kind("rounded, slide",
           [](const Scene& scene) { return is_round(scene) && scene.motion() == Motion::slide; }),
      kind(
          "cylinder, partial slip and roll",
          [](const Scene& scene) { return is_cylinder(scene) && scene.motion() != Motion::press; }),
      kind("cone, spin",
           [](const Scene& scene) {
             return scene.family() == Family::cone && scene.motion() == Motion::spin;
           }),
      kind("cone, partial slip",
           [](const Scene& scene) { return scene.family() == Family::cone && is_partial(scene); }),
      kind("cone, slide",
           [](const Scene& scene) {
             return scene.family() == Family::cone && scene.motion() == Motion::slide;
           }),
      kind("punch, spin",
           [](const Scene& scene) {
             return scene.family() == Family::punch && scene.motion() == Motion::spin;
           }),
      kind("punch, partial slip",
           [](const Scene& scene) { return scene.family() == Family::punch && is_partial(scene); }),
      kind("punch, slide",
           [](const Scene& scene) {
             return scene.family() == Family::punch && scene.motion() == Motion::slide;
           }),
      kind("press, any", [](const Scene& scene) { return scene.motion() == Motion::press; }),
  };
  return all;
}

Pooled pool(const std::vector<SceneResult>& results,
            const std::function<bool(const SceneResult&)>& holds,
            const std::function<std::optional<Score>(const SceneResult&)>& score_of_result) {
  Pooled pooled;
  for (const SceneResult& result : results) {
    if (!holds(result)) continue;
    const auto score = score_of_result(result);
    if (score) pooled.add(result, *score);
  }
  return pooled;
}

Pooled pool_method(const std::vector<SceneResult>& results, const Kind& kind, std::size_t method,
                   bool typical_noise) {
  return pool(
      results,
      [&](const SceneResult& result) {
        return kind.holds(result.scene) &&
               (!typical_noise || result.scene.noise_counts == kTypicalNoise);
      },
      [&](const SceneResult& result) { return result.by_method.at(method); });
}

std::string ratio_text(const Pooled& pooled) {
  return pooled.theta.open == 0 ? "–" : fmt::format("{:.3f}", pooled.ratio());
}

}  // namespace pillarfield::report
