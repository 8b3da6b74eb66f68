#pragma once

#include <cstdint>

#include "solve/pillar_maths.h"

namespace pillarfield {

/// Readings of a flawless sensor: equation (2), zero where V is negative or at most 1e-6 of the
/// pillar's largest |V|. That is the rounding error of single-precision forces, so a force on the
/// boundary of two regions belongs to the one with fewer readings.
[[nodiscard]] double_precision::Readings ideal_readings(double_precision::Force force,
                                                        double counts_per_newton);

/// Usable bits of the status byte if positive readings are usable.
[[nodiscard]] std::uint8_t usable_bits(const double_precision::Readings& readings);

}  // namespace pillarfield
