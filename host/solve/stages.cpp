#include "solve/stages.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace pillarfield {
namespace {

using Plan = SolverPlan;

constexpr bool is_always(const Plan& /*plan*/) { return true; }
constexpr const SensorEffects& effects(const Plan& plan) { return plan.calibration.effects; }
constexpr bool is_bent(const Plan& plan) { return !plan.calibration.bend_x.empty(); }
constexpr bool is_paper(const Plan& plan) { return plan.estimator == Estimator::paper; }

/// In the order of kernels/frame/stages.h.
constexpr std::array kStages = {
    Stage{"load", "PF_SENSEL", is_always},
    Stage{"reject_out_of_range", "PF_LARGEST_READING",
          [](const Plan& plan) { return plan.sensel_type == SenselType::f32; }},
    Stage{"mask", "PF_MASK", [](const Plan& plan) { return !plan.calibration.mask.empty(); }},
    Stage{"saturation", "PF_FULL_SCALE",
          [](const Plan& plan) { return plan.skin.full_scale_counts.has_value(); }},
    Stage{.name = "wires",
          .macro = "PF_WIRES",
          .is_named = [](const Plan& plan) { return effects(plan).wires.has_value(); },
          .place = StagePlace::frame},
    Stage{.name = "bend",
          .macro = "PF_BEND",
          .is_named = is_bent,
          .place = StagePlace::frame,
          .has_memory = true},
    Stage{"tare", "PF_TARE",
          [](const Plan& plan) {
            return !plan.calibration.tare.empty() || plan.baseline_rate || is_bent(plan);
          }},
    Stage{"wires_after_tare", "PF_WIRES_AFTER_TARE",
          [](const Plan& plan) { return has_offset_tares(effects(plan)); }},
    Stage{"gain", "PF_GAIN", [](const Plan& plan) { return !plan.calibration.gain.empty(); }},
    Stage{"power_law", "PF_POWER_EXPONENT",
          [](const Plan& plan) { return plan.skin.power_law.has_value(); }},
    Stage{"curve", "PF_CURVE", [](const Plan& plan) { return !effects(plan).curve.empty(); }},
    Stage{.name = "leak",
          .macro = "PF_LEAK",
          .is_named = [](const Plan& plan) { return effects(plan).sensel_leak.has_value(); }},
    Stage{.name = "memory",
          .macro = "PF_MEMORY",
          .is_named = [](const Plan& plan) { return effects(plan).memory.has_value(); },
          .has_memory = true},
    Stage{"classify", "PF_THRESHOLD", is_always},
    Stage{"dead_zone", "PF_DEAD_ZONE",
          [](const Plan& plan) { return !plan.calibration.dead_zone.empty(); }},
    Stage{"direct_solve", nullptr, [](const Plan& plan) { return !is_paper(plan); }},
    Stage{"paper_solve", "PF_PAPER", is_paper},
    Stage{"shear_coefficient", "PF_SHEAR_COEFFICIENT",
          [](const Plan& plan) { return effects(plan).shear_coefficient.has_value(); }},
    Stage{"residual", "PF_RESIDUAL",
          [](const Plan& plan) { return effects(plan).residual.has_value(); }},
    Stage{"parity_test", "PF_PARITY_TOLERANCE",
          [](const Plan& plan) { return plan.parity_tolerance_counts.has_value(); }},
    Stage{"angles", "PF_ANGLES", [](const Plan& plan) { return plan.angles; }},
    Stage{"uncertainty", "PF_UNCERTAINTY", [](const Plan& plan) { return plan.uncertainty; }},
    Stage{"store", nullptr, is_always},
    Stage{.name = "pillar_leak",
          .macro = "PF_PILLAR_LEAK",
          .is_named = [](const Plan& plan) { return effects(plan).pillar_leak.has_value(); },
          .place = StagePlace::frame},
    Stage{.name = "lean",
          .macro = "PF_LEAN",
          .is_named = [](const Plan& plan) { return effects(plan).arm_mm.has_value(); },
          .place = StagePlace::frame},
    Stage{.name = "shear_ratio",
          .macro = nullptr,
          .is_named = [](const Plan& plan) { return effects(plan).arm_mm.has_value(); },
          .place = StagePlace::frame},
    Stage{.name = "follow_baseline",
          .macro = "PF_BASELINE",
          .is_named = [](const Plan& plan) { return plan.baseline_rate.has_value(); },
          .place = StagePlace::frame,
          .has_memory = true},
    Stage{.name = "estimate_contacts",
          .macro = nullptr,
          .is_named = [](const Plan& plan) { return plan.estimator == Estimator::contact; },
          .place = StagePlace::host,
          .has_memory = true},
};

}  // namespace

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

}  // namespace pillarfield
