#include "device/kernel_source.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <string>

#include "lanes/calibration_memory.h"
#include "pillarfield/tuning.h"
#include "skin/quads.h"
#include "solve/activation_thresholds.h"
#include "solve/sensor_corrections.h"
#include "solve/stages.h"
#include "solve/whole_numbers.h"

namespace pillarfield {
namespace {

/// The macros of a program with their values.
using Definitions = std::map<std::string, std::string, std::less<>>;

/// A constant rounded to single precision, as exact text.
std::string hex_float(double value) { return fmt::format("{:a}f", single_constant(value)); }

std::string text_of(const StageConstant& constant, const SolverPlan& plan, bool whole) {
  if (!whole) return hex_float(constant.value);
  const double value = whole_value(constant, plan);
  return is_whole(constant.kind) ? fmt::format("{}", static_cast<int>(value)) : hex_float(value);
}

/// The values of an array as an initialiser.
template <std::size_t count>
std::string hex_list(const float (&values)[count]) {
  std::string list;
  for (const float value : values) list += (list.empty() ? "{" : ", ") + hex_float(value);
  return list + "}";
}

void define_memory(const SenselMemory& memory, double frame_interval_s, Definitions& all) {
  const auto model = memory_model(memory, frame_interval_s);
  all["PF_PLAYS"] = fmt::format("{}", memory.plays.size());
  all["PF_CREEPS"] = fmt::format("{}", memory.creep.size());
  all["PF_PLAY_WIDTHS"] = hex_list(model.play_width);
  all["PF_PLAY_WEIGHTS"] = hex_list(model.play_weight);
  all["PF_CREEP_DECAYS"] = hex_list(model.creep_decay);
  all["PF_CREEP_RATES"] = hex_list(model.creep_rate);
  all["PF_CREEP_WEIGHTS"] = hex_list(model.creep_weight);
}

void define_wires(const WireCrosstalk& wires, Definitions& all) {
  all["PF_TILE_ROWS"] = fmt::format("{}", wires.tile_rows);
  all["PF_TILE_COLS"] = fmt::format("{}", wires.tile_cols);
  all["PF_ROW_PER_COUNT"] = hex_float(wires.row_per_count);
  all["PF_COLUMN_PER_COUNT"] = hex_float(wires.column_per_count);
  all["PF_IDLE_PER_COUNT"] = hex_float(wires.idle_per_count);
}

/// Adds the models of a real sensor's effects.
void define_effects(const SolverPlan& plan, Definitions& all) {
  const SensorEffects& effects = plan.calibration.effects;
  if (!effects.curve.empty()) {
    const auto curve = curve_polynomial(effects.curve).polynomial;
    all["PF_CURVE_COEFFICIENTS"] = hex_list(curve.terms);
    all["PF_CURVE_PER_COUNT"] = hex_float(curve.per_count);
    all["PF_CURVE_ROOT"] = fmt::format("{}", curve.root);
  }
  if (effects.memory) define_memory(*effects.memory, plan.frame_interval_s, all);
  if (effects.wires) define_wires(*effects.wires, all);
}

/// The stages and constants of a plan; `whole`: in whole numbers.
Definitions definitions(const SolverPlan& plan, bool whole) {
  Definitions all;
  for (const Stage& stage : stages_of(plan)) {
    if (stage.has_macro()) all[stage.macro] = "";
  }
  for (const StageConstant& constant : stage_constants(plan)) {
    if (!constant.is_needed) continue;
    all[std::string("PF_VALUE_") + constant.name] = text_of(constant, plan, whole);
  }
  all["PF_SENSEL"] = sensel_macro(plan.sensel_type);
  define_effects(plan, all);
  if (whole) all["PF_WHOLE"] = fmt::format("{}", kUnitsPerCount);
  if (plan.uncertainty && !plan.calibration.noise.empty()) all["PF_NOISE"] = "";
  return all;
}

/// Adds the constants for skipping idle blocks.
void define_idle_range(const SolverPlan& plan, Definitions& all) {
  const ActivationRange range = activation_range(plan);
  all["PF_SKIP_IDLE"] = "";
  if (!has_activation_plane(plan))
    all["PF_ACTIVATION"] = hex_float(activation_thresholds(plan).front());
  all["PF_ACTIVATION_CUT"] = hex_float(range.threshold);
  all["PF_ACTIVATION_STEP"] = hex_float(range.step);
  all["PF_ACTIVATION_LOWEST"] = hex_float(range.lowest);
  all["PF_ACTIVATION_HIGHEST"] = hex_float(range.highest);
  all["PF_ACTIVATION_NEVER"] = hex_float(range.never);
  if (has_offset_tares(plan.calibration.effects)) all["PF_IDLE_LOAD"] = hex_float(idle_load(plan));
}

/// The macro that holds the plane's index.
const char* macro_of(CalibrationPlane plane) {
  static constexpr std::array kMacros = {
      "PF_TARE_PLANE",    "PF_GAIN_PLANE",       "PF_DEAD_ZONE_PLANE", "PF_NOISE_PLANE",
      "PF_MASK_PLANE",    "PF_ACTIVATION_PLANE", "PF_BEND_X_PLANE",    "PF_BEND_Y_PLANE",
      "PF_BEND_XY_PLANE", "PF_RELEASE_PLANE",    "PF_RELEASED_PLANE",  "PF_MEMORY_PLANE"};
  return kMacros[static_cast<std::size_t>(plane)];
}

}  // namespace

std::vector<std::string> kernel_stages(const SolverPlan& plan) {
  std::vector<std::string> names;
  for (const Stage& stage : stages_of(plan)) names.emplace_back(stage.name);
  return names;
}

std::string kernel_source(const SolverPlan& plan, int device_lanes, const SpeedPaths& paths) {
  const int lanes = block_lanes(device_lanes, quad_cols(plan.skin));
  // A single lane has 32 bits anyway.
  const bool whole = lanes > 1 && is_whole(plan);
  Definitions all = definitions(plan, whole);
  all["PF_LANES"] = fmt::format("{}", lanes);
  if (paths.stores == Stores::streaming && lanes > 1) all["PF_STREAM"] = "";
  if (paths.skip_idle) define_idle_range(plan, all);
  std::size_t place = 0;
  const bool has_activation = paths.skip_idle && has_activation_plane(plan);
  for (const CalibrationPlane plane : calibration_planes(plan, has_activation)) {
    all.emplace(macro_of(plane), fmt::format("{}", place++));
  }
  std::string source;
  for (const auto& [macro, value] : all) source += fmt::format("#define {} {}\n", macro, value);
  source += kernel_program();
  return source;
}

}  // namespace pillarfield
