#pragma once

#include <vector>

#include "pillarfield/solver_plan.h"

namespace pillarfield {

enum class StagePlace : std::uint8_t {
  pillar,  ///< kernels/frame/stages.h: in solve_frame.cl
  frame,   ///< an entry point of its own in kernels/frame: reads the frame
  host,    ///< after the device: reads the frame's results
};

/// A stage of the solve.
struct Stage {
  const char* name = nullptr;
  const char* macro = nullptr;  ///< defined where the stage is named; null: the stage always runs
  bool (*is_named)(const SolverPlan& plan) = nullptr;
  StagePlace place = StagePlace::pillar;
  bool has_memory = false;  ///< keeps state from frame to frame; frames are solved in their order
};

/// The stages that a plan names, in order.
[[nodiscard]] std::vector<Stage> stages_of(const SolverPlan& plan);

/// True if frames must be solved in their order on the device.
[[nodiscard]] bool has_memory_on_device(const SolverPlan& plan);

}  // namespace pillarfield
