#include "simulation/indenter/indenter_path.h"

#include <algorithm>
#include <cmath>

#include "simulation/path_place.h"

namespace pillarfield {

IndenterKey state_at(const Indenter& indenter, double time_s) {
  const auto [from, to, fraction] = place_on(indenter.path, time_s);
  return {time_s, std::lerp(from.x_mm, to.x_mm, fraction), std::lerp(from.y_mm, to.y_mm, fraction),
          std::lerp(from.angle_deg, to.angle_deg, fraction),
          std::lerp(from.load_n, to.load_n, fraction)};
}

double steps_of(const Indenter& indenter, double rate_hz, std::uint64_t frames) {
  const double moving = std::ceil(indenter.path.back().time_s * rate_hz);
  return std::min(moving, static_cast<double>(frames)) * indenter.substeps;
}

}  // namespace pillarfield
