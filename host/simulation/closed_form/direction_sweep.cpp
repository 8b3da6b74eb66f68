#include "simulation/closed_form/direction_sweep.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "simulation/path_place.h"

namespace pillarfield {

std::uint64_t pillar_rows(const DirectionSweep& sweep) {
  return std::uint64_t{sweep.inclinations} * sweep.magnitudes_n.size();
}

double factor_at(const DirectionSweep& sweep, double time_s) {
  const auto [from, to, fraction] = place_on(sweep.path, time_s);
  return std::lerp(from.factor, to.factor, fraction);
}

ForceField direction_sweep_forces(const DirectionSweep& sweep) {
  using std::numbers::pi;
  ForceField forces(static_cast<std::uint32_t>(pillar_rows(sweep)), sweep.directions);
  const double theta_step =
      sweep.inclinations > 1 ? sweep.max_theta_deg * pi / 180 / (sweep.inclinations - 1) : 0;
  const double phi_step = 2 * pi / sweep.directions;
  std::size_t pillar = 0;
  for (const double magnitude : sweep.magnitudes_n) {
    for (std::uint32_t inclination = 0; inclination < sweep.inclinations; ++inclination) {
      const double shear = magnitude * std::sin(inclination * theta_step);
      const double normal = magnitude * std::cos(inclination * theta_step);
      for (std::uint32_t direction = 0; direction < sweep.directions; ++direction, ++pillar) {
        forces.shear_x[pillar] = static_cast<float>(-shear * std::cos(direction * phi_step));
        forces.shear_y[pillar] = static_cast<float>(-shear * std::sin(direction * phi_step));
        forces.normal[pillar] = static_cast<float>(normal);
      }
    }
  }
  return forces;
}

}  // namespace pillarfield
