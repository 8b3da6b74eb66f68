#pragma once

#include <vector>

#include "pillarfield/sensor_effects.h"

namespace pillarfield {

/// Response that all sensels share: force = curve(reading) + dead_zone_n.
struct CommonResponse {
  ResponseCurve curve;     ///< its loads are forces, N
  double dead_zone_n = 0;  ///< force below which the sensels read zero

  /// Force at a reading above zero.
  [[nodiscard]] double force_at(double reading) const {
    return load_at(curve, reading) + dead_zone_n;
  }
};

/// The response through readings under known forces: two or more of each, above zero, increasing.
/// The dead zone is that for which log(force − dead zone) is nearest a line in log(reading), the
/// power law, or where that fits much better, nearest such a line with a term in the reading, a
/// bent curve; 0 with two or three forces. Two knots below the first force and one beyond the last
/// continue the response as the power law through the nearest two, or along the bent curve, which
/// also gives a knot between any two.
[[nodiscard]] CommonResponse fit_common_response(const std::vector<double>& forces_n,
                                                 const std::vector<double>& readings);

}  // namespace pillarfield
