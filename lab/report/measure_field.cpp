// measure_field SCENES: the measurements of docs/field.md, as one JSON document on standard output.
// Errors depend on nothing but the code; times do. SCENES is the folder of the scenes.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "lab/studies/contact_study.h"
#include "lab/studies/contact_study_histories.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/processor.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "pillarfield/status.h"

namespace pillarfield::report {
namespace {

using contact_study::Evaluation;
using contact_study::History;
using contact_study::Recording;
using contact_study::Score;
using Json = nlohmann::ordered_json;

// --- Methods ---

/// A way to estimate the forces of a recording.
struct Method {
  std::string name;
  Estimator estimator = Estimator::contact;
  double segment_point = SolverPlan{}.segment_point;
  FrictionKnowledge friction = {};
  bool friction_given = false;
  double bound_over_friction = 0;  ///< 0: no bound

  [[nodiscard]] std::vector<ForceField> solve(const Recording& recording) const {
    SolverPlan plan = recording.plan;
    plan.estimator = estimator;
    plan.segment_point = segment_point;
    plan.friction = friction;
    if (friction_given) plan.friction.given = recording.friction;
    if (bound_over_friction > 0) plan.friction.bound = bound_over_friction * recording.friction;
    return contact_study::solve(recording, plan);
  }
};

const Method kDirect = {.name = "direct", .estimator = Estimator::direct};
const Method kPaper = {.name = "paper", .estimator = Estimator::paper};
const Method kContact = {.name = "contact"};

std::vector<Method> all_methods() {
  std::vector<Method> all = {kDirect, kPaper, kContact, {.name = "given", .friction_given = true}};
  for (const double point : {0.5, 0.75}) {
    all.push_back({.name = fmt::format("direct_{}", point),
                   .estimator = Estimator::direct,
                   .segment_point = point});
  }
  all.push_back({.name = "unrelated", .friction = {.memory = false}});
  all.push_back({.name = "bounded", .bound_over_friction = 1.5});
  for (const double spread : {0.5, 1.0}) {
    for (const double median : {0.5, 1.0, 2.0, 3.0}) {
      all.push_back({.name = fmt::format("prior_{}_{}", median, spread),
                     .friction = {.median = median, .spread = spread}});
    }
  }
  return all;
}

// --- Recordings and their scores ---

Json json_of(const Score& score) {
  return {{"loaded", score.loaded},
          {"ambiguous", score.ambiguous},
          {"squares", score.squares},
          {"held", score.held},
          {"held_with_noise", score.held_with_noise},
          {"frames", score.frames},
          {"total_errors", score.total_errors},
          {"total_squares", score.total_squares}};
}

/// Scores by method; "noise" is the error that noise alone leaves.
Json scores_of(const Recording& recording, const std::vector<Method>& methods) {
  const Evaluation evaluation(recording);
  Json scores = {{"noise", json_of(evaluation.score(evaluation.nearest()))}};
  for (const Method& method : methods) {
    scores[method.name] = json_of(evaluation.score(method.solve(recording)));
  }
  return scores;
}

Json learnt_json(const Recording& recording) {
  Json contacts = Json::array();
  for (const auto& learnt : contact_study::friction_estimates(recording)) {
    contacts.push_back({{"pillars", learnt.pillars},
                        {"median", learnt.median},
                        {"spread", learnt.spread},
                        {"used", learnt.used},
                        {"slipping", learnt.slipping}});
  }
  return contacts;
}

Json histories_json(const std::filesystem::path& scenes) {
  const auto& histories = contact_study::histories();
  const std::vector<Method> methods = all_methods();
  std::vector<Json> results(histories.size());
  contact_study::for_each_index(results.size(), [&](std::size_t i) {
    const History& history = histories[i];
    const Recording recording = contact_study::record(history, scenes);
    results[i] = {{"name", history.name()},
                  {"indenter", name_of(history.indenter)},
                  {"loading", name_of(history.loading)},
                  {"radius_pillars", history.radius_pillars},
                  {"friction", history.friction},
                  {"scores", scores_of(recording, methods)},
                  {"learnt", learnt_json(recording)}};
  });
  return results;
}

// --- One history in detail ---

/// A finger that is dragged until it slides.
bool is_shown(const History& history) {
  return history.indenter == contact_study::Indenter::fingertip &&
         history.loading == contact_study::Loading::slide && history.friction == 1.6;
}

/// The mean normal force of a frame's ambiguous pillars, and forces of the pillars of the last
/// frame; counts.
Json shown_history_json(const std::filesystem::path& scenes) {
  const auto& all = contact_study::histories();
  const Recording recording = contact_study::record(*std::ranges::find_if(all, is_shown), scenes);
  const Evaluation evaluation(recording);
  const double counts = recording.plan.skin.counts_per_newton;
  const auto contact = kContact.solve(recording);
  const auto direct = kDirect.solve(recording);
  const auto paper = kPaper.solve(recording);
  Json frames = Json::array();
  for (std::size_t frame = 0; frame < recording.frames.size(); ++frame) {
    const auto& ambiguous = evaluation.ambiguous(frame);
    const auto mean = [&](const ForceField& field) {
      double sum = 0;
      for (const std::size_t i : ambiguous) sum += field.normal[i];
      return counts * sum / static_cast<double>(ambiguous.size());
    };
    frames.push_back({{"frame", frame},
                      {"ambiguous", ambiguous.size()},
                      {"truth", mean(recording.truth[frame])},
                      {"contact", mean(contact[frame])},
                      {"direct", mean(direct[frame])},
                      {"paper", mean(paper[frame])}});
  }
  Json pillars = Json::array();
  for (const std::size_t i : evaluation.ambiguous(recording.frames.size() - 1)) {
    pillars.push_back(
        {{"truth", counts * recording.truth.back().normal[i]},
         {"contact", counts * contact.back().normal[i]},
         {"contact_deviation", counts * contact.back().uncertainty[Uncertainty::normal][i]},
         {"paper", counts * paper.back().normal[i]}});
  }
  return {{"name", recording.name}, {"frames", std::move(frames)}, {"pillars", std::move(pillars)}};
}

// --- Cost ---

constexpr int kRounds = 40;

/// What solving a frame took, round by round.
struct Costs {
  std::vector<double> seconds;
  std::vector<double> clocks;  ///< of the processor, all threads
};

/// Follows the contacts of the result too, where there is a tracker.
void add_cost(Processor& processor, const FrameBuffer& frame, ContactTracker* tracker,
              Costs& costs) {
  const std::clock_t clock = std::clock();
  const auto begin = std::chrono::steady_clock::now();
  processor.submit(frame.view());
  const ForceFieldView forces = processor.receive();
  if (tracker != nullptr) tracker->update(forces, 0, processor.contacts());
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  costs.seconds.push_back(taken.count());
  costs.clocks.push_back(static_cast<double>(std::clock() - clock));
}

/// The two orders of a round have different times: a median would fall between them.
double mean_of_middle_half(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const auto quarter = static_cast<std::ptrdiff_t>(times.size() / 4);
  const double sum = std::accumulate(times.begin() + quarter, times.end() - quarter, 0.0);
  return sum / static_cast<double>(times.end() - times.begin() - 2 * quarter);
}

/// Time and processor time of `contact` over those of the direct solve, by turns.
Json over_direct(const Device& device, const SolverPlan& plan, const FrameBuffer& frame,
                 ContactTracker* tracker) {
  constexpr int kWarmUps = 4;
  SolverPlan direct_plan = plan;
  direct_plan.estimator = Estimator::direct;
  Processor contact(device, plan);
  Processor direct(device, direct_plan);
  Costs contact_costs;
  Costs direct_costs;
  for (int round = -kWarmUps; round < kRounds; ++round) {
    if (round == 0) contact_costs = direct_costs = {};
    // The second of a round finds the frame in the caches.
    const bool contact_first = round % 2 == 0;
    if (contact_first) add_cost(contact, frame, tracker, contact_costs);
    add_cost(direct, frame, nullptr, direct_costs);
    if (!contact_first) add_cost(contact, frame, tracker, contact_costs);
  }
  return {{"time",
           mean_of_middle_half(contact_costs.seconds) / mean_of_middle_half(direct_costs.seconds)},
          {"processor",
           mean_of_middle_half(contact_costs.clocks) / mean_of_middle_half(direct_costs.clocks)}};
}

Json cost_json(const std::filesystem::path& scene) {
  const Simulator simulator(load_scene(scene));
  SolverPlan plan;
  plan.skin = simulator.scene().skin;
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  set_solver(plan, simulator.scene());
  plan.estimator = Estimator::contact;
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  ForceField truth(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  simulator.render(simulator.scene().frames / 2, frame, truth);
  const auto pillars = static_cast<double>(truth.elements());
  const auto loaded =
      static_cast<double>(std::ranges::count_if(truth.status, [](auto bits) { return bits != 0; }));
  const auto ambiguous = static_cast<double>(std::ranges::count_if(
      truth.status, [](auto bits) { return region_of(bits) == Region::three; }));
  const Device device = open_device();
  ContactTracker tracker(plan.skin.pillar_pitch_mm());
  return {{"device", device.info().name},
          {"rounds", kRounds},
          {"contact_share", loaded / pillars},
          {"ambiguous_share", ambiguous / loaded},
          {"contact", over_direct(device, plan, frame, nullptr)},
          {"tracked", over_direct(device, plan, frame, &tracker)}};
}

Json all(const std::filesystem::path& scenes) {
  return {{"cost", cost_json(scenes / "square_metre.toml")},
          {"histories", histories_json(scenes)},
          {"shown_history", shown_history_json(scenes)}};
}

}  // namespace
}  // namespace pillarfield::report

int main(int count, char** words) {
  if (count != 2) {
    std::fputs("usage: measure_field SCENES\n", stderr);
    return 2;
  }
  try {
    std::puts(pillarfield::report::all(words[1]).dump().c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "measure_field: %s\n", error.what());
    return 1;
  }
  return 0;
}
