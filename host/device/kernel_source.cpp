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

/// Defines the sizes of the memory of a real sensor's effects.
void define_sizes(const SensorEffects& effects, Definitions& all) {
  if (effects.memory) {
    all["PF_PLAYS"] = fmt::format("{}", effects.memory->plays.size());
    all["PF_CREEPS"] = fmt::format("{}", effects.memory->creep.size());
  }
  if (effects.wires) {
    all["PF_TILE_ROWS"] = fmt::format("{}", effects.wires->tile_rows);
    all["PF_TILE_COLS"] = fmt::format("{}", effects.wires->tile_cols);
  }
}

/// The stages of a plan; `whole`: in whole numbers.
Definitions definitions(const SolverPlan& plan, bool whole) {
  Definitions all;
  for (const Stage& stage : stages_of(plan)) {
    if (stage.has_macro()) all[stage.macro] = "";
  }
  all["PF_SENSEL"] = sensel_macro(plan.sensel_type);
  define_sizes(plan.calibration.effects, all);
  if (whole) all["PF_WHOLE"] = fmt::format("{}", kUnitsPerCount);
  if (plan.uncertainty && !plan.calibration.noise.empty()) all["PF_NOISE"] = "";
  return all;
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

bool solves_in_whole_numbers(const SolverPlan& plan, int lanes) {
  return lanes > 1 && is_whole(plan);  // A single lane has 32 bits anyway.
}

std::string kernel_source(const SolverPlan& plan, int device_lanes, const SpeedPaths& paths) {
  const int lanes = block_lanes(device_lanes, quad_cols(plan.skin));
  const bool whole = solves_in_whole_numbers(plan, lanes);
  Definitions all = definitions(plan, whole);
  all["PF_LANES"] = fmt::format("{}", lanes);
  if (paths.stores == Stores::streaming && lanes > 1) all["PF_STREAM"] = "";
  if (paths.skip_idle) all["PF_SKIP_IDLE"] = "";
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
