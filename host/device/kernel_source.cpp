#include "device/kernel_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "device/calibration_memory.h"
#include "pillarfield/error.h"
#include "pillarfield/tuning.h"
#include "skin/quads.h"
#include "solve/activation_thresholds.h"
#include "solve/sensor_corrections.h"
#include "solve/stages.h"

namespace pillarfield {
namespace {

/// The macros of a program with their values.
using Definitions = std::map<std::string, std::string, std::less<>>;

/// A constant rounded to single precision, as exact text.
std::string hex_float(double value) {
  const auto rounded = static_cast<float>(value);
  if (std::isfinite(rounded)) return fmt::format("{:a}f", rounded);
  throw Error("solver plan", fmt::format("a constant of the kernel is {}", value),
              "check the skin and the calibration for values that are far too large or small");
}

/// The unit of whole numbers, 1/16 count: readings are whole counts, thresholds multiples of 1/2,
/// and the segment point divides their sums by at most 8.
constexpr int kUnitsPerCount = 16;

/// Largest threshold for whole numbers: four of them fit into 16 bits.
constexpr double kLargestWholeThreshold = 500;

/// Constants are clamped to this many counts: larger ones compare alike with readings of 8 bits.
constexpr double kManyCounts = 1000;

/// The segment point of whole-number programs: n of 1 - 1 / 2^n.
std::optional<int> whole_segment_point(const SolverPlan& plan) {
  for (int n = 1; n <= 3; ++n) {
    if (plan.segment_point == 1 - std::ldexp(1.0, -n)) return n;
  }
  return std::nullopt;
}

/// True if the solve of a plan computes only multiples of 1/16 count, and no sensel is missing
/// (docs/derivations/direct_solve.md, section 6).
bool is_whole(const SolverPlan& plan) {
  const Calibration& calibration = plan.calibration;
  const auto threshold = static_cast<float>(plan.skin.threshold_counts);
  const bool corrects = !calibration.tare.empty() || !calibration.gain.empty() ||
                        !calibration.dead_zone.empty() || !calibration.mask.empty() ||
                        !calibration.bend_x.empty() || !calibration.effects.empty() ||
                        plan.baseline_rate || plan.skin.power_law;
  const bool halves =
      threshold <= kLargestWholeThreshold && 2 * threshold == std::floor(2 * threshold);
  const bool saturates_below =
      plan.skin.full_scale_counts && static_cast<float>(*plan.skin.full_scale_counts) <= threshold;
  return plan.sensel_type == SenselType::u8 && plan.skin.has_pillars() &&
         plan.estimator != Estimator::paper && !corrects && !plan.angles && !plan.uncertainty &&
         halves && !saturates_below && whole_segment_point(plan);
}

/// A limit in counts in a program of whole numbers, rounded so that comparisons do not change.
std::string whole_limit(double value, double (*round)(double)) {
  const double units = kUnitsPerCount * std::min<double>(static_cast<float>(value), kManyCounts);
  return fmt::format("{}", static_cast<int>(round(units)));
}

std::string text_of(const StageConstant& constant, const SolverPlan& plan, bool whole) {
  if (!whole) return hex_float(constant.value);
  switch (constant.kind) {
    case ConstantKind::exact:
      break;
    case ConstantKind::above:
      return whole_limit(constant.value, std::floor);
    case ConstantKind::from:
      return whole_limit(constant.value, std::ceil);
    case ConstantKind::per_count:
      return hex_float(constant.value / kUnitsPerCount);
    case ConstantKind::fraction:
      return fmt::format("{}", *whole_segment_point(plan));
  }
  return hex_float(constant.value);
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
  for (const CalibrationPlane plane : calibration_planes(plan, paths)) {
    all.emplace(macro_of(plane), fmt::format("{}", place++));
  }
  std::string source;
  for (const auto& [macro, value] : all) source += fmt::format("#define {} {}\n", macro, value);
  source += kernel_program();
  return source;
}

}  // namespace pillarfield
