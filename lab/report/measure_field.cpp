// measure_field SCENES: the measurements of docs/field.md, as one JSON document on standard output.
// Errors depend on nothing but the code; times do. SCENES is the folder of the scenes.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "lab/studies/contact_study.h"
#include "lab/studies/contact_study_histories.h"
#include "lab/studies/contact_study_scenes.h"
#include "lab/studies/contact_study_twins.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/processor.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "pillarfield/status.h"

namespace pillarfield::report {
namespace {

using contact_study::ClosedForm;
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

/// What is tried on single frames.
std::vector<Method> basic_methods() {
  return {kDirect, kPaper, kContact, {.name = "given", .friction_given = true}};
}

/// What is tried on histories.
std::vector<Method> all_methods() {
  std::vector<Method> all = basic_methods();
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

Json closed_forms_json() {
  const std::vector<Method> methods = basic_methods();
  std::vector<ClosedForm> scenes = contact_study::closed_forms();
  contact_study::integrate(scenes);
  std::vector<Json> results(scenes.size());
  contact_study::for_each_index(results.size(), [&](std::size_t i) {
    const bool is_cylinder = scenes[i].contact.body.shape == contact_study::Shape::cylinder;
    results[i] = {{"family", is_cylinder ? "cylinder" : name_of(scenes[i].family())},
                  {"motion", name_of(scenes[i].motion())},
                  {"scores", scores_of(contact_study::record(scenes[i]), methods)}};
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

// --- Twins ---

template <class DistanceOf>
double rms(const std::vector<std::size_t>& pillars, DistanceOf distance_of) {
  double squares = 0;
  for (const std::size_t i : pillars) squares += std::pow(distance_of(i), 2);
  return std::sqrt(squares / static_cast<double>(pillars.size()));
}

/// Readings of twins that differ in single precision.
std::size_t different_readings(const contact_study::Twins& twins) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < twins.first.size(); ++i) {
    const auto a = contact_study::readings_counts(twins.first[i]);
    const auto b = contact_study::readings_counts(twins.second[i]);
    for (std::size_t n = 0; n < a.size(); ++n) {
      if (static_cast<float>(a[n]) != static_cast<float>(b[n])) ++different;
    }
  }
  return different;
}

ClosedForm first_of(const contact_study::TwinScene& twin_scene) {
  ClosedForm scene;
  scene.contact = contact_study::contact_of(twin_scene);
  scene.contact_name = "twin";
  scene.friction = twin_scene.friction;
  scene.seed = 700'001;
  scene.loads =
      std::make_shared<contact_study::PillarLoads>(contact_study::loads_of(scene.contact));
  return scene;
}

Json twins_json() {
  contact_study::TwinScene scene;
  const Recording recording = contact_study::record(first_of(scene));
  const Evaluation evaluation(recording);
  const auto& ambiguous = evaluation.ambiguous(0);
  const ForceField contact = kContact.solve(recording).front();
  const ForceField paper = kPaper.solve(recording).front();
  std::size_t different = 0;
  Json rows = Json::array();
  for (const double share : {0.5, 0.7, 0.9}) {
    scene.normal_share = share;
    const contact_study::Twins twins = contact_study::sliding_twins(scene);
    different += different_readings(twins);
    const auto error = [&](const ForceField& solved, const auto& truth) {
      return rms(ambiguous, [&](std::size_t i) {
        return contact_study::distance_counts(
            {solved.shear_x[i], solved.shear_y[i], solved.normal[i]}, truth[i]);
      });
    };
    rows.push_back({{"normal_share", share},
                    {"friction", twins.second_friction},
                    {"direction_deg", twins.second_direction_deg},
                    {"distance", rms(ambiguous,
                                     [&](std::size_t i) {
                                       return contact_study::distance_counts(twins.first[i],
                                                                             twins.second[i]);
                                     })},
                    {"contact", {error(contact, twins.first), error(contact, twins.second)}},
                    {"paper", {error(paper, twins.first), error(paper, twins.second)}}});
  }
  return {{"diameter", 2 * scene.radius},
          {"peak_counts", scene.peak_counts},
          {"friction", scene.friction},
          {"direction_deg", scene.direction_deg},
          {"readings", 4 * recording.truth.front().pillars()},
          {"different_readings", different},
          {"rows", std::move(rows)}};
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
  const auto pillars = static_cast<double>(truth.pillars());
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
          {"shown_history", shown_history_json(scenes)},
          {"closed_forms", closed_forms_json()},
          {"twins", twins_json()}};
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
