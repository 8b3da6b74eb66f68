#pragma once

#include <vector>

#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// What decides whether a raw reading wakes its sensel (kernels/frame/idle.h), all in counts and
/// exact in single precision.
struct ActivationRange {
  double threshold;  ///< a reading is silent up to it, after tare and gain, before the power law
  double step;       ///< from one reading to the next: 1, or 0 for fractions
  double lowest;     ///< of a level
  double highest;    ///< of a level: saturated readings are active
  double never;      ///< the level of a masked sensel
};

[[nodiscard]] ActivationRange activation_range(const SolverPlan& plan);

/// Whether sensels of a plan differ in what wakes them.
[[nodiscard]] bool has_activation_plane(const SolverPlan& plan);

/// The raw reading from which on each sensel [rows, cols] may be more than silent; a single one for
/// all sensels of a plan without tare, gain and mask. A block of pillars with lower readings alone
/// has forces and status that do not depend on them.
[[nodiscard]] std::vector<float> activation_thresholds(const SolverPlan& plan);

}  // namespace pillarfield
