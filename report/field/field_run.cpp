#include "report/field/field_run.h"

#include <fmt/format.h>

namespace pillarfield::report {
namespace {

using field_study::ClosedForm;
using field_study::Evaluation;
using field_study::Family;
using field_study::Motion;
using field_study::Recording;
using field_study::Shape;

void set_contact(SolverPlan& plan, const FrictionKnowledge& friction) {
  plan.estimator = Estimator::contact;
  plan.friction = friction;
}

Method prior(double median, double spread) {
  return {fmt::format("median {:g}, spread {:.1f}", median, spread), [=](SolverPlan& plan, double) {
            FrictionKnowledge friction;
            friction.median = median;
            friction.spread = spread;
            set_contact(plan, friction);
          }};
}

std::vector<Method> all_methods() {
  std::vector<Method> all = {
      {"`direct`", [](SolverPlan&, double) {}},
      {"`direct`, segment point 0.5", [](SolverPlan& plan, double) { plan.segment_point = 0.5; }},
      {"`paper`", [](SolverPlan& plan, double) { plan.estimator = Estimator::paper; }},
      {"`contact`", [](SolverPlan& plan, double) { set_contact(plan, {}); }},
      {"`contact`, frames unrelated",
       [](SolverPlan& plan, double) {
         set_contact(plan, {});
         plan.friction.memory = false;
       }},
      {"`contact`, true friction given",
       [](SolverPlan& plan, double friction) {
         set_contact(plan, {});
         plan.friction.given = friction;
       }},
      {"median 1, spread 0.5, bound 1.5 times the true friction",
       [](SolverPlan& plan, double friction) {
         set_contact(plan, {});
         plan.friction.bound = 1.5 * friction;
       }},
      {"`direct`, segment point 0.75", [](SolverPlan& plan, double) { plan.segment_point = 0.75; }},
  };
  for (const double spread : {0.5, 1.0}) {
    for (const double median : {0.5, 1.0, 2.0, 3.0}) all.push_back(prior(median, spread));
  }
  return all;
}

Result score(const Recording& recording, std::size_t method_count) {
  const Evaluation evaluation(recording);
  Result result;
  result.nearest = evaluation.score(evaluation.nearest());
  for (std::size_t i = 0; i < method_count; ++i) {
    SolverPlan plan = recording.plan;
    methods()[i].set(plan, recording.friction);
    result.by_method.push_back(evaluation.score(field_study::solve(recording, plan)));
  }
  return result;
}

bool is_cylinder(const ClosedForm& scene) { return scene.contact.body.shape == Shape::cylinder; }

/// Round in every direction: a cylinder's ends are abrupt.
bool is_round(const ClosedForm& scene) {
  return scene.family() == Family::rounded && !is_cylinder(scene);
}

bool is_partial(const ClosedForm& scene) {
  return scene.motion() == Motion::partial_slip || scene.motion() == Motion::partial_turn;
}

Kind kind(const char* name, bool (*holds)(const ClosedForm&)) { return {name, holds}; }

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> all = all_methods();
  return all;
}

double Result::to_paper(std::size_t method) const {
  const double paper = by_method.at(kPaper).rms_counts();
  return paper > 0 ? by_method.at(method).rms_counts() / paper : 0;
}

std::vector<HistoryResult> measure_histories(const std::filesystem::path& scenes) {
  const auto& histories = field_study::histories();
  std::vector<HistoryResult> results(histories.size());
  field_study::for_each_index(results.size(), [&](std::size_t i) {
    const Recording recording = field_study::record(histories[i], scenes);
    results[i] = {score(recording, methods().size()), histories[i],
                  field_study::learnt_friction(recording)};
  });
  return results;
}

std::vector<ClosedFormResult> measure_closed_forms() {
  std::vector<ClosedForm> scenes = field_study::closed_forms();
  field_study::integrate(scenes);
  std::vector<ClosedFormResult> results(scenes.size());
  field_study::for_each_index(results.size(), [&](std::size_t i) {
    results[i] = {score(field_study::record(scenes[i]), kBounded), scenes[i]};
  });
  return results;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      kind("rounded, spin and turn",
           [](const ClosedForm& scene) {
             return is_round(scene) &&
                    (scene.motion() == Motion::spin || scene.motion() == Motion::turn);
           }),
      kind("rounded, partial slip",
           [](const ClosedForm& scene) { return is_round(scene) && is_partial(scene); }),
      kind("rounded, roll",
           [](const ClosedForm& scene) {
             return is_round(scene) && scene.motion() == Motion::roll;
           }),
      kind("rounded, slide",
           [](const ClosedForm& scene) {
             return is_round(scene) && scene.motion() == Motion::slide;
           }),
      kind("cylinder, partial slip and roll",
           [](const ClosedForm& scene) {
             return is_cylinder(scene) && scene.motion() != Motion::press;
           }),
      kind("cone, spin",
           [](const ClosedForm& scene) {
             return scene.family() == Family::cone && scene.motion() == Motion::spin;
           }),
      kind("cone, partial slip",
           [](const ClosedForm& scene) {
             return scene.family() == Family::cone && is_partial(scene);
           }),
      kind("cone, slide",
           [](const ClosedForm& scene) {
             return scene.family() == Family::cone && scene.motion() == Motion::slide;
           }),
      kind("punch, spin",
           [](const ClosedForm& scene) {
             return scene.family() == Family::punch && scene.motion() == Motion::spin;
           }),
      kind("punch, partial slip",
           [](const ClosedForm& scene) {
             return scene.family() == Family::punch && is_partial(scene);
           }),
      kind("punch, slide",
           [](const ClosedForm& scene) {
             return scene.family() == Family::punch && scene.motion() == Motion::slide;
           }),
      kind("press, any", [](const ClosedForm& scene) { return scene.motion() == Motion::press; }),
  };
  return all;
}

std::string rms_text(const field_study::Score& score) {
  return score.open == 0 ? "–" : fmt::format("{:.2f}", score.rms_counts());
}

std::string percent_text(double share) { return fmt::format("{:.1f}", 100 * share); }

}  // namespace pillarfield::report
