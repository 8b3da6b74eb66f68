#include "simulation/ideal_readings.h"

#include <algorithm>
#include <cmath>

#include "pillarfield/status.h"

namespace pillarfield {

using double_precision::Force;
using double_precision::Readings;

Readings ideal_readings(Force force, double counts_per_newton) {
  const Readings v = double_precision::model_readings(force, counts_per_newton);
  const double margin =
      1e-6 * std::max({std::abs(v.v1), std::abs(v.v2), std::abs(v.v3), std::abs(v.v4)});
  const auto positive = [=](double reading) { return reading > margin ? reading : 0.0; };
  return {positive(v.v1), positive(v.v2), positive(v.v3), positive(v.v4)};
}

std::uint8_t usable_bits(const Readings& readings) {
  const int bits =
      (readings.v1 > 0 ? status::kSensel1 : 0) | (readings.v2 > 0 ? status::kSensel2 : 0) |
      (readings.v3 > 0 ? status::kSensel3 : 0) | (readings.v4 > 0 ? status::kSensel4 : 0);
  return static_cast<std::uint8_t>(bits);
}

}  // namespace pillarfield
