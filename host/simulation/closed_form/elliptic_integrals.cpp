#include "simulation/closed_form/elliptic_integrals.h"

#include <algorithm>
#include <cmath>

namespace pillarfield {

CarlsonIntegrals carlson_integrals(double x, double y, double z) {
  // What remains after duplication depends on the spread of the arguments in second order only.
  constexpr double kSpread = 1e-8;
  double sum = 0;
  double weight = 1;
  while (std::max({x, y, z}) > (1 + kSpread) * std::min({x, y, z})) {
    const double root_x = std::sqrt(x);
    const double root_y = std::sqrt(y);
    const double root_z = std::sqrt(z);
    const double lambda = root_x * root_y + root_y * root_z + root_z * root_x;
    sum += weight / (root_z * (z + lambda));
    weight /= 4;
    x = (x + lambda) / 4;
    y = (y + lambda) / 4;
    z = (z + lambda) / 4;
  }
  const double mean_first = (x + y + z) / 3;
  const double mean_second = (x + y + 3 * z) / 5;
  return {1 / std::sqrt(mean_first), 3 * sum + weight / (mean_second * std::sqrt(mean_second))};
}

}  // namespace pillarfield
