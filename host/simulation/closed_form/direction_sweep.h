#pragma once

#include <cstdint>

#include "pillarfield/force_field.h"
#include "pillarfield/scene.h"

namespace pillarfield {

/// Number of pillar rows: `inclinations` per magnitude.
[[nodiscard]] std::uint64_t pillar_rows(const DirectionSweep& sweep);

/// Forces from (theta, phi): theta from 0 in the first row of a block to max_theta_deg in the last,
/// phi from 0 in the first column. Status bytes are zero.
[[nodiscard]] ForceField direction_sweep_forces(const DirectionSweep& sweep);

}  // namespace pillarfield
