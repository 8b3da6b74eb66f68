#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pillarfield/calibration_file.h"
#include "pillarfield/error.h"
#include "pillarfield/scene.h"
#include "pillarfield/solver_plan.h"
#include "pillarfield/tuning.h"
#include "python/arrays.h"
#include "python/bindings.h"

namespace pillarfield::python {
namespace {

constexpr const char* kPlan = R"(The sensor and what to compute.

skin: Skin, with rows and columns of the frames
sensel_type: 'uint8', 'uint16' or 'float32'
calibration: Calibration, or the path of its file
scene: Scene, or the path of its file; its constants and options replace those of skin
estimator: 'direct', 'paper' or 'contact'
outputs: of 'angles' and 'uncertainty', beside the forces
segment_point: position of the force of an ambiguous pillar on its segment, (0, 1]
friction: friction coefficient if it is known to 3 %, 0.1..9.9
friction_bound: its upper bound, 0.1..100
friction_prior: (median, spread of the logarithm) of the friction
unrelated_frames: consecutive frames are unrelated; nothing is carried over
threshold_counts, counts_per_newton, full_scale_counts: replace constants of the skin
parity_tolerance_counts: tolerance of V1 + V3 = V2 + V4; None: no test
noise_counts: standard deviation of a raw reading, counts
baseline_time_s: time constant with which the tare follows drift, s; None: it is fixed
baseline_interval: frames over which its update is spread, 1..1024
frame_interval_s: time from frame to frame, s

Raises Error for a value out of range or options that exclude each other.)";

template <class T>
using ValueOrPath = std::variant<T, std::filesystem::path>;

template <class T, class Read>
T value_of(const ValueOrPath<T>& given, Read read) {
  if (const auto* const path = std::get_if<std::filesystem::path>(&given)) return read(*path);
  return std::get<T>(given);
}

template <class Choice, std::size_t n>
Choice choice_named(const std::string& name, const std::array<Choice, n>& choices,
                    const char* what) {
  std::string names;
  for (const Choice choice : choices) {
    if (name == name_of(choice)) return choice;
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", name_of(choice));
  }
  throw Error("Plan", fmt::format("'{}' is no {}", name, what),
              fmt::format("give one of {}", names));
}

constexpr std::array kTypes = {SenselType::u8, SenselType::u16, SenselType::f32};
constexpr std::array kEstimators = {Estimator::direct, Estimator::paper, Estimator::contact};

void set_outputs(SolverPlan& plan, const std::vector<std::string>& outputs) {
  plan.angles = plan.uncertainty = false;
  for (const std::string& output : outputs) {
    if (output != "angles" && output != "uncertainty") {
      throw Error("Plan", fmt::format("'{}' is no output", output),
                  "give a list of 'angles' and 'uncertainty'");
    }
    (output == "angles" ? plan.angles : plan.uncertainty) = true;
  }
}

/// Applies a scene and returns its time constant of the baseline.
std::optional<double> apply(const Scene& scene, SolverPlan& plan) {
  set_skin(plan.skin, scene);
  set_solver(plan, scene);
  return scene.baseline_time_s;
}

/// Sets `member` to a value that was given.
template <class Member, class Value>
void set(Member& member, const std::optional<Value>& value) {
  if (value) member = *value;
}

SolverPlan make_plan(
    const Skin& skin, const std::string& sensel_type,
    const std::optional<ValueOrPath<SkinCalibration>>& calibration,
    const std::optional<ValueOrPath<Scene>>& scene, const std::optional<std::string>& estimator,
    const std::optional<std::vector<std::string>>& outputs, std::optional<double> segment_point,
    std::optional<double> friction, std::optional<double> friction_bound,
    const std::optional<std::pair<double, double>>& friction_prior, bool unrelated_frames,
    std::optional<double> threshold_counts, std::optional<double> counts_per_newton,
    std::optional<double> full_scale_counts, std::optional<double> parity_tolerance_counts,
    std::optional<double> noise_counts, std::optional<double> baseline_time_s,
    std::optional<int> baseline_interval, std::optional<double> frame_interval_s) {
  SolverPlan plan;
  plan.skin = skin;
  plan.sensel_type = choice_named(sensel_type, kTypes, "type of readings");
  std::optional<double> baseline;
  if (scene) {
    baseline = apply(value_of(*scene, [](const auto& path) { return load_scene(path); }), plan);
  }
  if (calibration) {
    const SkinCalibration given =
        value_of(*calibration, [](const auto& path) { return read_calibration_file(path); });
    require_fitting(given, plan.skin, "Plan");
    apply(given, plan.skin, plan.calibration);
  }
  if (estimator) plan.estimator = choice_named(*estimator, kEstimators, "estimator");
  if (outputs) set_outputs(plan, *outputs);
  set(plan.segment_point, segment_point);
  set(plan.friction.given, friction);
  set(plan.friction.bound, friction_bound);
  if (friction_prior) std::tie(plan.friction.median, plan.friction.spread) = *friction_prior;
  if (unrelated_frames) plan.friction.memory = false;
  set(plan.skin.threshold_counts, threshold_counts);
  set(plan.skin.counts_per_newton, counts_per_newton);
  set(plan.skin.full_scale_counts, full_scale_counts);
  set(plan.parity_tolerance_counts, parity_tolerance_counts);
  set(plan.noise_counts, noise_counts);
  set(plan.frame_interval_s, frame_interval_s);
  set(baseline, baseline_time_s);
  if (baseline) plan.baseline_rate = baseline_rate(*baseline, plan.frame_interval_s);
  set(plan.baseline_interval, baseline_interval);
  check(plan, "Plan");
  return plan;
}

std::string plan_text(const SolverPlan& plan) {
  return fmt::format("<Plan {} x {} {}, estimator '{}'{}{}>", plan.skin.rows, plan.skin.cols,
                     name_of(plan.sensel_type), name_of(plan.estimator),
                     plan.angles ? ", angles" : "", plan.uncertainty ? ", uncertainty" : "");
}

}  // namespace

void bind_plan(py::module_& module) {
  const py::none unset;
  py::class_<SolverPlan>(module, "Plan", kPlan)
      .def(py::init(&make_plan), py::arg("skin"), py::kw_only(), py::arg("sensel_type") = "uint8",
           py::arg("calibration") = unset, py::arg("scene") = unset, py::arg("estimator") = unset,
           py::arg("outputs") = unset, py::arg("segment_point") = unset,
           py::arg("friction") = unset, py::arg("friction_bound") = unset,
           py::arg("friction_prior") = unset, py::arg("unrelated_frames") = false,
           py::arg("threshold_counts") = unset, py::arg("counts_per_newton") = unset,
           py::arg("full_scale_counts") = unset, py::arg("parity_tolerance_counts") = unset,
           py::arg("noise_counts") = unset, py::arg("baseline_time_s") = unset,
           py::arg("baseline_interval") = unset, py::arg("frame_interval_s") = unset)
      .def_readonly("skin", &SolverPlan::skin, "its Skin, with all constants applied")
      .def_property_readonly(
          "sensel_type", [](const SolverPlan& plan) { return name_of(plan.sensel_type); },
          "'uint8', 'uint16' or 'float32'")
      .def_readonly("frame_interval_s", &SolverPlan::frame_interval_s, "s")
      .def_property_readonly(
          "estimator", [](const SolverPlan& plan) { return name_of(plan.estimator); },
          "'direct', 'paper' or 'contact'")
      .def_property_readonly(
          "stages", [](const SolverPlan& plan) { return kernel_stages(plan); },
          "names of the stages that are compiled into the kernel")
      .def("__repr__", &plan_text);
}

}  // namespace pillarfield::python
