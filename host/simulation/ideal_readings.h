#pragma once

#include <cstdint>

#include "solve/pillar_maths.h"

namespace pillarfield {

/// The readings of a flawless sensor: those of equation (2), zero where the pillar lifts off.
///
/// A reading of at most 1e-6 of the pillar's largest in magnitude is zero too. Forces are kept in
/// single precision, so that is the margin in a reading that ought to vanish, and a force on the
/// boundary between two regions belongs to the one with fewer readings.
[[nodiscard]] double_precision::Readings ideal_readings(double_precision::Force force,
                                                        double counts_per_newton);

/// The usable bits of the status byte for readings of which the positive ones are usable.
[[nodiscard]] std::uint8_t usable_bits(const double_precision::Readings& readings);

}  // namespace pillarfield
