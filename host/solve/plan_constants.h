#pragma once

#include "pillarfield/solver_plan.h"
#include "solve/pillar_maths.h"
#include "solve/stages.h"

namespace pillarfield {

/// The stages that a plan names, without their constants, in the precision of `Stages`:
/// single_precision::Stages or double_precision::Stages.
template <class Stages>
Stages named_stages(const SolverPlan& plan) {
  Stages stages{};
  const std::span<const Stage> all = all_stages();
  std::size_t i = 0;
#define PF_SET(name, macro, place, has_memory, named) stages.name = all[i++].is_named(plan);
  PF_STAGES(PF_SET)
#undef PF_SET
  return stages;
}

/// The stages that a plan names, with their constants but for the polynomial of the response curve
/// and the model of hysteresis and creep.
template <class Stages>
Stages plan_constants(const SolverPlan& plan) {
  Stages stages = named_stages<Stages>(plan);
  const std::vector<StageConstant> constants = stage_constants(plan);
  std::size_t i = 0;
#define PF_SET(name, needed, kind, formula) \
  stages.name = static_cast<decltype(stages.name)>(constants[i++].value);
  PF_STAGE_CONSTANTS(PF_SET)
#undef PF_SET
  return stages;
}

}  // namespace pillarfield
