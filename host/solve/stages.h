#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/solver_plan.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

enum class StagePlace : std::uint8_t {
  pillar,  ///< kernels/frame/stages.h: in solve_frame.cl
  frame,   ///< an entry point of its own in kernels/frame: reads the frame
  host,    ///< after the device: reads the frame's results
};

/// A stage of the solve, in kernels/frame/stage_table.h.
struct Stage {
  const char* name = nullptr;
  const char* macro = nullptr;  ///< defined where the stage is named, or "none"
  bool (*is_named)(const SolverPlan& plan) = nullptr;
  StagePlace place = StagePlace::pillar;
  bool has_memory = false;  ///< keeps state from frame to frame; frames are solved in their order

  [[nodiscard]] bool has_macro() const;
};

/// All stages, in order.
[[nodiscard]] std::span<const Stage> all_stages();

/// The stages that a plan names, in order.
[[nodiscard]] std::vector<Stage> stages_of(const SolverPlan& plan);

/// Form of a constant in a program of whole numbers: kernels/frame/stage_table.h.
enum class ConstantKind : std::uint8_t { exact, above, from, per_count, fraction };

/// A constant of the stages.
struct StageConstant {
  const char* name;
  bool is_needed;  ///< by the stages that the plan names
  ConstantKind kind;
  double value;
};

/// The constants of a plan, in the order of kernels/frame/stage_table.h.
[[nodiscard]] std::vector<StageConstant> stage_constants(const SolverPlan& plan);

/// The numbers of a plan, as its programs take them (kernels/plan.h); `whole`: of a program of
/// whole numbers. Throws Error if one is not finite.
[[nodiscard]] single_precision::PlanNumbers plan_numbers(const SolverPlan& plan, bool whole);

/// True if frames must be solved in their order on the device.
[[nodiscard]] bool has_memory_on_device(const SolverPlan& plan);

/// True if the forces of a plan are corrected by those of the pillars around, or what is derived
/// from them follows such a correction.
[[nodiscard]] bool corrects_forces(const SolverPlan& plan);

/// A constant in single precision, as kernels take it. Throws Error if it is not finite.
[[nodiscard]] float single_constant(double value);

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

}  // namespace pillarfield
