#pragma once

#include <cstdint>
#include <span>

#include "pillarfield/sensor_effects.h"

namespace pillarfield {

/// Overwrites V, [rows, cols], by what sensels read that also answer a fraction of their
/// neighbours' V (E3). Beyond the array V is zero.
void leak_between_sensels(const SenselLeak& leak, std::uint32_t rows, std::uint32_t cols,
                          std::span<double> v);

}  // namespace pillarfield
