#include "solve/stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>

#include "pillarfield/error.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"
#include "solve/activation_thresholds.h"
#include "solve/sensor_corrections.h"
#include "solve/whole_numbers.h"

namespace pillarfield {
namespace {

constexpr std::array kStages = {
#define PF_STAGE(name, macro, place, has_memory, named)                             \
  Stage{#name, #macro,                                                              \
        [](const SolverPlan& plan) {                                                \
          [[maybe_unused]] const SensorEffects& effects = plan.calibration.effects; \
          return static_cast<bool>(named);                                          \
        },                                                                          \
        StagePlace::place, has_memory},
    PF_STAGES(PF_STAGE)
#undef PF_STAGE
};

}  // namespace

bool Stage::has_macro() const { return std::string_view(macro) != "none"; }

std::span<const Stage> all_stages() { return kStages; }

std::vector<Stage> stages_of(const SolverPlan& plan) {
  std::vector<Stage> stages;
  std::ranges::copy_if(kStages, std::back_inserter(stages),
                       [&](const Stage& stage) { return stage.is_named(plan); });
  return stages;
}

bool has_memory_on_device(const SolverPlan& plan) {
  return std::ranges::any_of(stages_of(plan), [](const Stage& stage) {
    return stage.has_memory && stage.place != StagePlace::host;
  });
}

bool corrects_forces(const SolverPlan& plan) {
  const SensorEffects& effects = plan.calibration.effects;
  return effects.arm_mm || (effects.pillar_leak && (plan.angles || plan.uncertainty));
}

float single_constant(double value) {
  const auto rounded = static_cast<float>(value);
  if (std::isfinite(rounded)) return rounded;
  throw Error("solver plan", fmt::format("a constant of the kernel is {}", value),
              "check the skin and the calibration for values that are far too large or small");
}

std::vector<StageConstant> stage_constants(const SolverPlan& plan) {
  const auto is = named_stages<double_precision::Stages>(plan);
  const SensorEffects& effects = plan.calibration.effects;
  const PowerLaw power_law = plan.skin.power_law.value_or(PowerLaw{});
  const ForceScale scale = force_scale(plan.skin);
  const ShearCoefficient coefficient = effects.shear_coefficient.value_or(ShearCoefficient{});
  const ResidualError residual = effects.residual.value_or(ResidualError{});
  const WireCrosstalk wires = effects.wires.value_or(WireCrosstalk{});
  const ActivationRange activation = activation_range(plan);
  const double of_all = has_activation_plane(plan) ? 0 : activation_thresholds(plan).front();
  const double residual_variance = residual.offset_counts * residual.offset_counts;
  const auto leak =
      effects.sensel_leak ? leak_taps(*effects.sensel_leak) : double_precision::LeakTaps{};
  const PillarTaps pillar_leak =
      effects.pillar_leak ? pillar_leak_taps(*effects.pillar_leak) : PillarTaps{};
  return {
#define PF_VALUE_OF(name, needed, kind, value) {#name, needed, ConstantKind::kind, value},
      PF_STAGE_CONSTANTS(PF_VALUE_OF)
#undef PF_VALUE_OF
  };
}

single_precision::PlanNumbers plan_numbers(const SolverPlan& plan, bool whole) {
  const std::vector<StageConstant> constants = stage_constants(plan);
  std::size_t i = 0;
  const auto next = [&] {
    const StageConstant& constant = constants[i++];
    if (!constant.is_needed) return 0.0F;
    return single_constant(whole ? whole_value(constant, plan) : constant.value);
  };
  single_precision::PlanNumbers numbers{};
#define PF_SET(name, needed, kind, formula) numbers.name = next();
  PF_STAGE_CONSTANTS(PF_SET)
#undef PF_SET
  numbers.largest = static_cast<float>(kMaxCounts);  // find_wires.cl reads it of all types
  const SensorEffects& effects = plan.calibration.effects;
  if (!effects.curve.empty()) numbers.curve_polynomial = curve_polynomial(effects.curve).polynomial;
  if (effects.memory) numbers.memory_model = memory_model(*effects.memory, plan.frame_interval_s);
  return numbers;
}

}  // namespace pillarfield
