#pragma once

#include <vector>

#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Parameters of the activation thresholds (kernels/frame/idle.h), counts, exact in single
/// precision.
struct ActivationRange {
  double threshold;  ///< a reading up to it is inactive, after tare and gain, before the power law
  double step;       ///< between readings: 1, or 0 for fractions
  double lowest;     ///< lowest activation threshold
  double highest;    ///< highest activation threshold: saturated readings are active
  double never;      ///< activation threshold of a masked sensel
};

[[nodiscard]] ActivationRange activation_range(const SolverPlan& plan);

/// True if the activation threshold differs between sensels of a plan.
[[nodiscard]] bool has_activation_plane(const SolverPlan& plan);

/// Activation threshold of each sensel [rows, cols], raw counts; a single one for a plan without
/// tare, gain and mask. Forces and status of a block do not depend on readings below it.
[[nodiscard]] std::vector<float> activation_thresholds(const SolverPlan& plan);

/// The most that an idle sensel reads above its tare, counts, whatever its tare.
[[nodiscard]] double idle_load(const SolverPlan& plan);

}  // namespace pillarfield
