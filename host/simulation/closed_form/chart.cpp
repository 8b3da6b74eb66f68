#include "simulation/closed_form/chart.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace pillarfield {

std::uint64_t pillar_rows(const Chart& chart) {
  return std::uint64_t{chart.inclinations} * chart.magnitudes_n.size();
}

ForceField chart_forces(const Chart& chart) {
  using std::numbers::pi;
  ForceField forces(static_cast<std::uint32_t>(pillar_rows(chart)), chart.directions);
  const double theta_step =
      chart.inclinations > 1 ? chart.max_theta_deg * pi / 180 / (chart.inclinations - 1) : 0;
  const double phi_step = 2 * pi / chart.directions;
  std::size_t pillar = 0;
  for (const double magnitude : chart.magnitudes_n) {
    for (std::uint32_t inclination = 0; inclination < chart.inclinations; ++inclination) {
      const double shear = magnitude * std::sin(inclination * theta_step);
      const double normal = magnitude * std::cos(inclination * theta_step);
      for (std::uint32_t direction = 0; direction < chart.directions; ++direction, ++pillar) {
        forces.shear_x[pillar] = static_cast<float>(-shear * std::cos(direction * phi_step));
        forces.shear_y[pillar] = static_cast<float>(-shear * std::sin(direction * phi_step));
        forces.normal[pillar] = static_cast<float>(normal);
      }
    }
  }
  return forces;
}

}  // namespace pillarfield
