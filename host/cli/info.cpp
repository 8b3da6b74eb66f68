// pillarfield info: contents of a file, OpenCL devices, kernel of a scene.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>

#include "base/number_text.h"
#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/warnings.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/printable.h"
#include "pillarfield/processor.h"
#include "pillarfield/recording.h"
#include "pillarfield/simulator.h"
#include "pillarfield/tuning.h"
#include "pillarfield/version.h"
#include "skin/effect_parameters.h"
#include "skin/skin_fields.h"

namespace pillarfield::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Returns a value as text: the members of a list, and of an object with their names.
std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return rounded(value.get<double>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (!value.is_structured()) return json_text(value);
  std::vector<std::string> parts;
  for (const auto& [key, part] : value.items()) {
    parts.push_back(value.is_object() ? key + " " + text_of(part) : text_of(part));
  }
  return fmt::format("{}", fmt::join(parts, value.is_object() ? ", " : " "));
}

void print_fact(const std::string& key, const Json& value) {
  fmt::print("{:<20} {}\n", key, printable(text_of(value)));
}

/// Prints `facts` as JSON, or one "key value" line each.
void print_facts(const Json& facts, bool json) {
  if (json) {
    fmt::print("{}\n", json_text(facts));
    return;
  }
  for (const auto& [key, value] : facts.items()) {
    if (value.is_array()) {
      for (const Json& item : value) print_fact(key, item);
    } else {
      print_fact(key, value);
    }
  }
}

std::vector<std::string> plane_names(const Calibration& calibration) {
  std::vector<std::string> names;
  visit_planes(calibration, [&](const PlaneField& field, const auto& plane) {
    if (!plane.empty()) names.emplace_back(field.name);
  });
  return names;
}

void add_effects(Json& facts, const SensorEffects& effects) {
  for (const EffectParameter& parameter : parameters_of(effects)) {
    // An object, so that text names the parameter of a list once.
    Json& value = facts["effects"][parameter.name];
    if (parameter.list) {
      value = parameter.values;
    } else {
      value = parameter.values.front();
    }
  }
}

/// Adds the constants of a Skin or SkinCalibration that are set.
template <class Constants>
void add_constants(Json& facts, const Constants& of) {
  visit_constants(of, [&](const NumberField& field, const std::optional<double>& value) {
    if (value) facts[field.name] = *value;
  });
  for (const auto& [field, member] : kPowerLawFields) {
    if (of.power_law) facts[field.name] = (*of.power_law).*member;
  }
}

void add_surface(Json& facts, const std::optional<Surface>& surface) {
  if (!surface) return;
  facts["surface"] = name_of(surface->shape);
  if (surface->radius_mm != 0) facts["surface_radius_mm"] = surface->radius_mm;
  if (surface->shape == SurfaceShape::cylinder) facts["surface_axis_deg"] = surface->axis_deg;
}

/// A number, or [from row to row, from column to column].
Json pitch_json(const Pitch& pitch) {
  return pitch.is_square() ? Json(pitch.col_mm) : Json::array({pitch.row_mm, pitch.col_mm});
}

void add_skin(Json& facts, const Skin& skin) {
  facts["sensel_rows"] = skin.rows;
  facts["sensel_cols"] = skin.cols;
  facts["layout"] = name_of(skin.layout);
  if (skin.falling) facts["falling"] = true;
  if (skin.has_pillars()) {
    facts["pillar_rows"] = skin.pillar_rows();
    facts["pillar_cols"] = skin.pillar_cols();
  }
  facts["sensel_pitch_mm"] = pitch_json(skin.sensel_pitch_mm);
  add_constants(facts, skin);
  add_surface(facts, skin.surface);
}

Json facts_of_frames(const std::string& file, const ReadOptions& options) {
  const std::unique_ptr<FrameSource> source = open_frames(file, options);
  Json facts = {{"format", source->format()}, {"frames", source->frames()}};
  facts["sensel_type"] = name_of(source->sensel_type());
  add_skin(facts, source->skin());
  if (source->frames() > 0) {
    // Also checks that the readings can be read.
    FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
    const double first = source->read(0, frame);
    const double seconds = source->read(source->frames() - 1, frame) - first;
    if (std::isfinite(seconds)) facts["seconds"] = seconds;
  }
  facts["calibration"] = plane_names(source->calibration());
  add_effects(facts, source->calibration().effects);
  facts["truth"] = source->has_truth();
  facts["warnings"] = source->warnings();
  return facts;
}

Json facts_of_forces(const std::string& file, const InfoOptions& options) {
  const ForceFileReader reader(file, options.read);
  const ForceFileInfo& info = reader.info();
  Json facts = {
      {"format", "force field"}, {"frames", reader.frames()}, {"layout", name_of(info.layout)}};
  const std::string element = info.layout == SkinLayout::pillars ? "pillar" : "sensel";
  facts[element + "_rows"] = info.rows;
  facts[element + "_cols"] = info.cols;
  facts[element + "_pitch_mm"] = pitch_json(info.element_pitch_mm);
  facts.update({{"estimator", info.estimator},
                {"device", info.device},
                {"source", info.source},
                {"angles", info.angles},
                {"pressure", info.pressure},
                {"uncertainty", info.uncertainty},
                {"contacts", info.contacts.has_value()},
                {"warnings", reader.warnings()}});
  if (info.segment_point) facts["segment_point"] = *info.segment_point;
  add_surface(facts, info.surface);
  if (info.first_frame > 0) facts["first_frame"] = info.first_frame;
  return facts;
}

Json facts_of_step(const CalibrationStep& step) {
  return {{"step", step.step},         {"sources", step.sources},
          {"frames", step.frames},     {"parameters", step.parameters},
          {"date_utc", step.date_utc}, {"program_version", step.program_version}};
}

Json facts_of_calibration(const std::string& file, const ReadOptions& read) {
  const SkinCalibration calibration = read_calibration_file(file, read);
  Json facts = {{"format", "calibration"},
                {"sensel_rows", calibration.rows},
                {"sensel_cols", calibration.cols},
                {"planes", plane_names(calibration.planes)},
                {"masked", count_masked(calibration.planes)},
                {"absent", count_absent(calibration.planes)}};
  add_constants(facts, calibration);
  if (calibration.threshold_factor) {
    facts[kThresholdFactor.name] = *calibration.threshold_factor;
  }
  add_effects(facts, calibration.planes.effects);
  facts["history"] = Json::array();
  for (const CalibrationStep& step : calibration.history) {
    facts["history"].push_back(facts_of_step(step));
  }
  return facts;
}

void add_indenters(Json& facts, const Scene& scene) {
  facts["bodies"] = scene.indenters.size();
  facts["modulus_kpa"] = scene.modulus_kpa;
  facts["height_maps"] = Json::array();
  for (const Indenter& indenter : scene.indenters) {
    if (!indenter.height_map.empty()) facts["height_maps"].push_back(indenter.height_map.string());
  }
}

Json facts_of_scene(const std::string& file) {
  const Scene scene = load_scene(file);
  Json facts = {{"format", "scene"},
                {"title", scene.title},
                {"frames", scene.frames},
                {"rate_hz", scene.rate_hz},
                {"seed", scene.seed}};
  if (const auto* contacts = std::get_if<std::vector<ClosedFormContact>>(&scene.load)) {
    facts["contacts"] = contacts->size();
  }
  if (!scene.indenters.empty()) add_indenters(facts, scene);
  add_skin(facts, scene.skin);
  if (scene.surface_map) facts["surface"] = scene.surface_map->path.string();
  facts["warnings"] = scene.warnings;
  return facts;
}

Json facts_of(const std::string& file, const InfoOptions& given) {
  const ReadOptions& options = given.read;
  if (file.ends_with(".toml")) return facts_of_scene(file);
  if (!options.dataset.empty()) return facts_of_frames(file, options);
  if (is_calibration_file(file)) return facts_of_calibration(file, options);
  return is_force_file(file) ? facts_of_forces(file, given) : facts_of_frames(file, options);
}

void print_device_error() {
  try {
    static_cast<void>(open_device("opencl"));
  } catch (const Error& error) {
    fmt::print("{}\n", error.what());
  }
}

void print_devices(bool json) {
  std::vector<DeviceInfo> devices = list_devices();
  const bool has_opencl = !devices.empty();
  devices.insert(devices.begin(), open_device("host").info());
  if (json) {
    Json list = Json::array();
    for (const DeviceInfo& device : devices) {
      list.push_back({{"index", device.index},
                      {"name", device.name},
                      {"platform", device.platform},
                      {"version", device.version},
                      {"type", device.type},
                      {"lanes", device.lanes},
                      {"shares_memory", device.shares_memory},
                      {"unsuitable", device.unsuitable},
                      {"kernel_cache", device.kernel_cache},
                      {"kernels_not_kept", device.kernels_not_kept}});
    }
    fmt::print("{}\n", json_text(list));
    return;
  }
  for (const DeviceInfo& device : devices) {
    const bool is_host = device.index < 0;
    fmt::print("{:>4}  {} ({}; {} lanes, {})  {}\n",
               is_host ? "host" : std::to_string(device.index), device.name,
               is_host ? "without OpenCL" : device.type + ", " + device.platform, device.lanes,
               device.shares_memory ? "zero copy" : "staged",
               device.unsuitable.empty() ? "suitable" : "passed over: " + device.unsuitable);
  }
  if (!has_opencl) return print_device_error();
  fmt::print(
      "Without --device: the host for small skins, else the best OpenCL device (GPU before CPU); "
      "one "
      "with memory of its own only if its first frames are as quick as the host's.\n");
}

/// Prints the stages and the kernel source for frames of the scene.
void print_kernel(const std::string& scene_file) {
  const Simulator simulator(load_scene_with_warnings(scene_file));
  const Scene& scene = simulator.scene();
  SolverPlan plan;
  plan.skin = scene.skin;
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  set_solver(plan, scene);
  const DeviceInfo device = open_device().info();
  fmt::print("// Stages on {}:", device.name);
  for (const std::string& stage : kernel_stages(plan)) fmt::print(" {}", stage);
  fmt::print("\n{}", kernel_source(plan, device.lanes));
}

}  // namespace

void info(const InfoOptions& options) {
  if (options.devices) {
    print_devices(options.json);
  } else if (!options.kernel.empty()) {
    print_kernel(options.kernel);
  } else if (!options.file.empty()) {
    print_facts(facts_of(options.file, options), options.json);
  } else {
    print_facts({{"version", kVersion}, {"license", "MIT"}}, options.json);
    print_devices(options.json);
  }
}

}  // namespace pillarfield::cli
