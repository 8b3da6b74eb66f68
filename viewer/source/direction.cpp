#include "viewer/source/direction.h"

#include <cmath>

namespace pillarfield::viewer {

Direction direction_of(float shear_x, float shear_y, float normal) {
  // Most pillars are not touched, and a negative zero must not turn theta around.
  if (shear_x == 0 && shear_y == 0 && normal == 0) return {};
  // Squares of floats neither overflow nor vanish in double precision.
  const double x = shear_x;
  const double y = shear_y;
  const double z = normal;
  const double shear_squared = x * x + y * y;
  Direction direction;
  direction.magnitude = static_cast<float>(std::sqrt(shear_squared + z * z));
  direction.theta = std::atan2(static_cast<float>(std::sqrt(shear_squared)), normal);
  // Subtracted, not negated: a component +0 must not become -0, on the far side of the cut.
  direction.phi = std::atan2(0.0F - shear_y, 0.0F - shear_x);
  return direction;
}

}  // namespace pillarfield::viewer
