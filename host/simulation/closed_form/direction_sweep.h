#pragma once

#include <cstdint>

#include "pillarfield/force_field.h"
#include "pillarfield/scene.h"

namespace pillarfield {

/// Number of pillar rows: `inclinations` per magnitude.
[[nodiscard]] std::uint64_t pillar_rows(const DirectionSweep& sweep);

/// Factor of the forces at `time_s`: linear between keys, constant before the first and after the
/// last.
[[nodiscard]] double factor_at(const DirectionSweep& sweep, double time_s);

/// Forces of factor 1 from (theta, phi): theta from 0 in the first row of a block to max_theta_deg
/// in the last, phi from 0 in the first column. Status bytes are zero.
[[nodiscard]] ForceField direction_sweep_forces(const DirectionSweep& sweep);

}  // namespace pillarfield
