#pragma once

#include <cstddef>

#include "device/calibration_memory.h"
#include "device/slot_memory.h"

namespace pillarfield {

/// How a frame is divided among work-items.
struct Division {
  int lanes = 1;          ///< pillars that one solves at once
  std::size_t bands = 1;  ///< bands of rows
  bool has_rings = true;  ///< each band keeps the rows around its own: kernels/frame/neighbours.h
};

/// The memory of a slot: results, idle flags, and scratch memory.
struct SlotLayout {
  SlotLayout(const SolverPlan& plan, const Division& division, bool skips_idle,
             const CalibrationMemory& calibration);

  ResultLayout results;
  single_precision::Layout layout{};
  std::size_t tiles_across = 0;  ///< of wires; 0 without their crosstalk
  std::size_t tiles_down = 0;
};

}  // namespace pillarfield
