#include "viewer/source/direction.h"

#include <cmath>

namespace pillarfield::viewer {

Direction direction_of(float shear_x, float shear_y, float normal) {
  // Most pillars carry no force; atan2 of a negative zero would give theta = pi.
  if (shear_x == 0 && shear_y == 0 && normal == 0) return {};
  // In double precision squares of floats neither overflow nor underflow.
  const double x = shear_x;
  const double y = shear_y;
  const double z = normal;
  const double shear_squared = x * x + y * y;
  Direction direction;
  direction.magnitude = static_cast<float>(std::sqrt(shear_squared + z * z));
  direction.theta = std::atan2(static_cast<float>(std::sqrt(shear_squared)), normal);
  // 0 - x maps +0 to +0; -x would give -0 and flip phi across the branch cut.
  direction.phi = std::atan2(0.0F - shear_y, 0.0F - shear_x);
  return direction;
}

}  // namespace pillarfield::viewer
