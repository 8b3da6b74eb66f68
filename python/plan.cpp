#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "base/nearest_word.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/error.h"
#include "pillarfield/plan_builder.h"
#include "pillarfield/scene.h"
#include "pillarfield/solver_plan.h"
#include "pillarfield/tuning.h"
#include "pillarfield/version.h"
#include "pipeline/plan_settings.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/frames.h"
#include "python/pitch.h"

namespace pillarfield::python {
namespace {

constexpr const char* kPlan = R"(The sensor and what to compute.

skin: Skin, with rows and columns of the frames
sensel_type: 'uint8', 'uint16' or 'float32'
calibration: Calibration, or the path of its file
scene: Scene, or the path of its file; its constants and options replace those of skin
layout: 'pillars' or 'sensels'; replaces that of skin and calibration
estimator: 'contact', 'direct' or 'paper'; None: 'contact', without pillars 'direct'
outputs: of 'angles' and 'uncertainty', beside the forces, and 'pressure', which files of them then hold
friction: friction coefficient if it is known to 3 %, 0.1..9.9
friction_bound: its upper bound, 0.1..100
friction_prior: (median, spread of the logarithm) of the friction
unrelated_frames: consecutive frames are unrelated; nothing is carried over
pitch_mm, threshold_counts, counts_per_newton, full_scale_counts: replace constants of the skin
parity_tolerance_counts: tolerance of V1 + V3 = V2 + V4; None: no test
noise_counts: standard deviation of a raw reading, counts
baseline_time_s: time constant with which the tare follows drift, s; None: it is fixed
baseline_interval: frames over which its update is spread, 1..1024; None: 1/100 of that time
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
  throw Error("Plan", fmt::format("'{}' is not a known {}", name, what),
              fmt::format("give one of {}", names));
}

constexpr std::array kTypes = {SenselType::u8, SenselType::u16, SenselType::f32};
constexpr std::array kLayouts = {SkinLayout::pillars, SkinLayout::sensels};
constexpr std::array kEstimators = {Estimator::direct, Estimator::paper, Estimator::contact};

std::vector<std::string> outputs_of(const py::handle& given) {
  auto outputs = argument<std::vector<std::string>>(given, "outputs");
  for (const std::string& output : outputs) {
    if (std::ranges::find(kPlanOutputs, output) == std::end(kPlanOutputs)) {
      throw Error("Plan", fmt::format("'{}' is not an output", output),
                  "give a list of 'angles', 'uncertainty' and 'pressure'");
    }
  }
  outputs.emplace_back("forces");  // An empty list replaces the outputs of a scene.
  return outputs;
}

/// Sets a setting by its name; false if there is none of this name.
bool set(PlanSettings& settings, const std::string& name, const py::handle& value) {
  for (const PlanSetting& setting : kPlanSettings) {
    if (name != setting.name) continue;
    settings.*setting.member =
        setting.whole ? argument<int>(value, name) : argument<double>(value, name);
    return true;
  }
  if (name == "pitch_mm") {
    settings.sensel_pitch_mm = argument<Pitch>(value, name);
  } else if (name == "layout") {
    settings.layout = choice_named(argument<std::string>(value, name), kLayouts, "layout");
  } else if (name == "estimator") {
    settings.estimator = choice_named(argument<std::string>(value, name), kEstimators, "estimator");
  } else if (name == "outputs") {
    settings.outputs = outputs_of(value);
  } else if (name == "friction_prior") {
    const auto [median, spread] = argument<std::pair<double, double>>(value, name);
    settings.friction_prior = {median, spread};
  } else if (name == "unrelated_frames") {
    settings.unrelated_frames = argument<bool>(value, name);
  } else {
    return false;
  }
  return true;
}

/// Names of all arguments that set() takes, and of the others of Plan().
std::vector<std::string> plan_options() {
  std::vector<std::string> names = {"skin",           "sensel_type",     "calibration", "scene",
                                    "layout",         "pitch_mm",        "estimator",   "outputs",
                                    "friction_prior", "unrelated_frames"};
  for (const PlanSetting& setting : kPlanSettings) names.emplace_back(setting.name);
  return names;
}

PlanSettings settings_of(const py::kwargs& given) {
  PlanSettings settings;
  for (const auto& [key, value] : given) {
    const auto name = key.cast<std::string>();
    if (value.is_none()) continue;
    if (name == "segment_point") {
      throw Error("Plan", "segment_point is not a setting any more", "leave it out");
    }
    if (!set(settings, name, value))
      refuse("Plan", py::dict(py::arg(name.c_str()) = value), plan_options());
  }
  return settings;
}

using CalibrationOrPath = std::optional<ValueOrPath<SkinCalibration>>;
using SceneOrPath = std::optional<ValueOrPath<Scene>>;

SolverPlan plan_with(SolverPlan plan, const CalibrationOrPath& calibration,
                     const SceneOrPath& scene, const py::kwargs& given,
                     const std::function<double()>& frame_interval_s) {
  PlanSources from;
  from.settings = settings_of(given);
  std::optional<Scene> loaded_scene;
  std::optional<SkinCalibration> loaded;
  if (scene) {
    loaded_scene = value_of(*scene, [](const auto& path) { return load_scene(path); });
    from.scene = &*loaded_scene;
  }
  if (calibration) {
    loaded = value_of(*calibration, [](const auto& path) { return read_calibration_file(path); });
    from.calibration = &*loaded;
  }
  plan = build_plan(std::move(plan), from, "Plan", frame_interval_s);
  check(plan, "Plan");
  return plan;
}

SolverPlan make_plan(const Skin& skin, const std::string& sensel_type,
                     const CalibrationOrPath& calibration, const SceneOrPath& scene,
                     const py::kwargs& given) {
  SolverPlan plan;
  plan.skin = skin;
  plan.sensel_type = choice_named(sensel_type, kTypes, "type of readings");
  const double usual_s = plan.frame_interval_s;
  return plan_with(std::move(plan), calibration, scene, given, [&] { return usual_s; });
}

/// A plan for frames, which give its time from frame to frame.
SolverPlan plan_of(Frames& frames, const Skin& skin, const CalibrationOrPath& calibration,
                   const SceneOrPath& scene, const py::kwargs& given) {
  SolverPlan plan;
  plan.skin = skin;
  plan.skin.falling |= frames.source->skin().falling;
  plan.sensel_type = frames.source->sensel_type();
  return plan_with(std::move(plan), calibration, scene, given, [&] {
    // Its holder may wait for Python's lock.
    const py::gil_scoped_release unlocked;
    const std::lock_guard alone(frames.alone);
    return frame_interval_of(*frames.source, "frames");
  });
}

/// The scalars of a plan that are neither its skin nor its calibration.
auto scalars_of(auto& plan) {
  return std::tie(plan.parity_tolerance_counts, plan.noise_counts, plan.segment_point,
                  plan.friction.median, plan.friction.spread, plan.friction.given,
                  plan.friction.bound, plan.friction.memory, plan.baseline_rate,
                  plan.baseline_interval, plan.frame_interval_s, plan.angles, plan.uncertainty,
                  plan.pressure);
}

auto values_of(const auto& references) {
  return std::apply([](const auto&... value) { return std::make_tuple(value...); }, references);
}

py::tuple plan_state(const SolverPlan& plan) {
  SkinCalibration calibration = blank_calibration(plan.skin);
  calibration.planes = plan.calibration;
  return py::make_tuple(kVersion, plan.skin, name_of(plan.sensel_type), name_of(estimator_of(plan)),
                        calibration, values_of(scalars_of(plan)));
}

SolverPlan plan_from(const py::tuple& state) {
  check_version(state, "Plan");
  SolverPlan plan;
  plan.skin = state[1].cast<Skin>();
  plan.sensel_type = choice_named(state[2].cast<std::string>(), kTypes, "type of readings");
  plan.estimator = choice_named(state[3].cast<std::string>(), kEstimators, "estimator");
  plan.calibration = state[4].cast<SkinCalibration>().planes;
  scalars_of(plan) = state[5].cast<decltype(values_of(scalars_of(plan)))>();
  check(plan, "Plan");
  return plan;
}

std::string plan_text(const SolverPlan& plan) {
  return fmt::format("<Plan {} x {} {}, estimator '{}'{}{}>", plan.skin.rows, plan.skin.cols,
                     name_of(plan.sensel_type), name_of(estimator_of(plan)),
                     plan.angles ? ", angles" : "", plan.uncertainty ? ", uncertainty" : "");
}

}  // namespace

void bind_plan(py::module_& module) {
  const py::none unset;
  py::class_<SolverPlan>(module, "Plan", kPlan)
      .def(py::init(&make_plan), py::arg("skin"), py::kw_only(), py::arg("sensel_type") = "uint8",
           py::arg("calibration") = unset, py::arg("scene") = unset)
      .def_readonly("skin", &SolverPlan::skin, "its Skin, with all constants applied")
      .def_property_readonly(
          "sensel_type", [](const SolverPlan& plan) { return name_of(plan.sensel_type); },
          "'uint8', 'uint16' or 'float32'")
      .def_readonly("frame_interval_s", &SolverPlan::frame_interval_s, "s")
      .def_property_readonly(
          "estimator", [](const SolverPlan& plan) { return name_of(estimator_of(plan)); },
          "'direct', 'paper' or 'contact'")
      .def_property_readonly(
          "stages", [](const SolverPlan& plan) { return kernel_stages(plan); },
          "names of the stages that are compiled into the kernel")
      .def("__repr__", &plan_text)
      .def(py::pickle(&plan_state, &plan_from));
  module.def("suggestion", &suggestion, py::arg("word"), py::arg("candidates"),
             "'; did you mean ...?' for the nearest candidate, if one is near.");
  module.attr("plan_options") = py::cast(plan_options());
  module.def("plan_of", &plan_of, py::arg("frames"), py::arg("skin"), py::kw_only(),
             py::arg("calibration") = unset, py::arg("scene") = unset,
             "A Plan for frames, with their type and time from frame to frame.");
}

}  // namespace pillarfield::python
