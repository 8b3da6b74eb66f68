#pragma once

#include "pillarfield/solver_plan.h"
#include "solve/stages.h"

namespace pillarfield {

/// The unit of programs of whole numbers, 1/16 count: readings are whole counts, thresholds
/// multiples of 1/2, and the segment point divides their sums by at most 8.
inline constexpr int kUnitsPerCount = 16;

/// True if the solve of a plan computes only multiples of 1/16 count, and no sensel is missing
/// (docs/derivations/direct_solve.md, section 6).
[[nodiscard]] bool is_whole(const SolverPlan& plan);

/// True if this constant is a whole number in a program of whole numbers.
[[nodiscard]] bool is_whole(ConstantKind kind);

/// A constant for a program of whole numbers; requires is_whole(plan).
[[nodiscard]] double whole_value(const StageConstant& constant, const SolverPlan& plan);

}  // namespace pillarfield
