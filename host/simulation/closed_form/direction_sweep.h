#pragma once

#include <cstdint>

#include "pillarfield/force_field.h"
#include "pillarfield/scene.h"

namespace pillarfield {

/// Pillar rows of a sweep: a block of inclinations for each magnitude.
[[nodiscard]] std::uint64_t pillar_rows(const DirectionSweep& sweep);

/// The forces of a sweep, which come from (theta, phi): theta grows from 0 in the first row of a
/// block to max_theta_deg in the last, phi from 0 in the first column. Status bytes are zero.
[[nodiscard]] ForceField direction_sweep_forces(const DirectionSweep& sweep);

}  // namespace pillarfield
