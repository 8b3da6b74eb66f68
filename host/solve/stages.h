#pragma once

#include <vector>

#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Which code a stage is in.
enum class StagePlace : std::uint8_t {
  pillar,  ///< kernels/frame/stages.h: sees the sensels of one pillar, in one frame
  frame,   ///< an entry point of its own in kernels/frame: sees the frame
  host,    ///< after the device: sees the frame's results
};

/// A stage of the solve: what a plan has to say of it.
struct Stage {
  const char* name;
  const char* macro;  ///< that a program defines where the stage is named; null: it is always there
  bool (*is_named)(const SolverPlan& plan);
  StagePlace place = StagePlace::pillar;
  bool needs_neighbours = false;  ///< other sensels or pillars than those of one pillar
  bool has_memory = false;        ///< of earlier frames, which then are solved one after the other
  /// Whether activation_thresholds() and level_of() in kernels/frame/idle.h follow from it too, so
  /// that idle blocks may be skipped.
  bool may_skip_idle = true;
};

/// The stages that a plan names, in their order.
[[nodiscard]] std::vector<Stage> stages_of(const SolverPlan& plan);

/// Whether all of them let idle blocks be skipped.
[[nodiscard]] bool may_skip_idle(const SolverPlan& plan);

}  // namespace pillarfield
