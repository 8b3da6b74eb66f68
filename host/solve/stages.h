#pragma once

#include <vector>

#include "pillarfield/solver_plan.h"

namespace pillarfield {

enum class StagePlace : std::uint8_t {
  pillar,  ///< kernels/frame/stages.h: in solve_frame.cl
  frame,   ///< an entry point of its own in kernels/frame: reads the frame
  host,    ///< after the device: reads the frame's results
};

/// The most pillars beyond its own that a stage reads.
inline constexpr std::uint32_t kMostReach = 2;

/// A stage of the solve.
struct Stage {
  const char* name = nullptr;
  const char* macro = nullptr;  ///< defined where the stage is named; null: the stage always runs
  bool (*is_named)(const SolverPlan& plan) = nullptr;
  StagePlace place = StagePlace::pillar;
  std::uint32_t reach = 0;  ///< how many pillars beyond its own it reads
  bool has_memory = false;  ///< keeps state from frame to frame; frames are solved in their order
};

/// The stages that a plan names, in order.
[[nodiscard]] std::vector<Stage> stages_of(const SolverPlan& plan);

/// True if frames must be solved in their order on the device.
[[nodiscard]] bool has_memory_on_device(const SolverPlan& plan);

/// True if pillars whose readings, and those of their neighbours, did not change keep their forces:
/// no stage has a memory, reads whole wires or runs on the host.
[[nodiscard]] bool may_solve_changes(const SolverPlan& plan);

/// How many pillars beyond its own a sensel's reading may change the force of.
[[nodiscard]] std::uint32_t neighbour_reach(const SolverPlan& plan);

}  // namespace pillarfield
