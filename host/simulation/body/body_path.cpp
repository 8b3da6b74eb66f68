#include "simulation/body/body_path.h"

#include <algorithm>
#include <cmath>

namespace pillarfield {

BodyKey state_at(const Body& body, double time_s) {
  const std::vector<BodyKey>& path = body.path;
  const auto next = std::upper_bound(path.begin(), path.end(), time_s,
                                     [](double t, const BodyKey& k) { return t < k.time_s; });
  if (next == path.begin() || next == path.end()) {
    BodyKey still = next == path.begin() ? path.front() : path.back();
    still.time_s = time_s;
    return still;
  }
  const BodyKey& from = *(next - 1);
  const double fraction = (time_s - from.time_s) / (next->time_s - from.time_s);
  return {time_s, std::lerp(from.x_mm, next->x_mm, fraction),
          std::lerp(from.y_mm, next->y_mm, fraction),
          std::lerp(from.angle_deg, next->angle_deg, fraction),
          std::lerp(from.load_n, next->load_n, fraction)};
}

double steps_of(const Body& body, double rate_hz, std::uint64_t frames) {
  const double moving = std::ceil(body.path.back().time_s * rate_hz);
  return std::min(moving, static_cast<double>(frames)) * body.substeps;
}

}  // namespace pillarfield
