#pragma once

#include "pillarfield/processor.h"

namespace pillarfield {

/// Time that a device takes for a frame of a plan, s, by frames of a moving band of contact, a
/// twelfth of the skin, two in flight. Compiles the kernels first.
[[nodiscard]] double time_of_frame(const Device& device, const SolverPlan& plan);

}  // namespace pillarfield
