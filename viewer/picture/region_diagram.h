#pragma once

#include <array>
#include <vector>

#include "viewer/picture/view.h"

namespace pillarfield::viewer {

/// The paper's Figure 3: in the plane of phi (x, -pi..pi) and theta (y, 0..pi/2) the curves on
/// which one sensel lifts: for sensel n, theta where cos theta = sin theta cos(pi/4 (2n-1) - phi).
/// Points of sensel n = 1..4 (index 0..3), in ascending phi; pieces, since a curve exists only
/// where the cosine is positive and may leave at phi = +-pi.
[[nodiscard]] std::array<std::vector<std::vector<Vec2>>, 4> region_borders(int points_per_curve);

/// The paper's Figure 4: directions (phi, theta) that two adjacent usable readings leave possible,
/// from their exact segment: `low` and `high` are the two sensels' readings (counts, as the
/// model's, not below zero) of sensels n and n % 4 + 1. Continuous polyline; phi is unwrapped.
[[nodiscard]] std::vector<Vec2> ambiguity_contour(int sensel, double reading, double next_reading,
                                                  int points);

}  // namespace pillarfield::viewer
