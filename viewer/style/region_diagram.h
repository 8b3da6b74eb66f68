#pragma once

#include <array>
#include <vector>

#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// The paper's Figure 3: in the plane of phi (x, -pi..pi) and theta (y, 0..pi/2) the curves on
/// which one sensel lifts: for sensel n, theta where cos theta = sin theta cos(pi/4 (2n-1) - phi).
/// Of sensel n = 1..4 (index 0..3) the pieces in ascending phi, since a curve exists only where the
/// cosine is not negative and may leave at phi = +-pi; each begins and ends on the diagram's edge
/// (theta = pi/2 or phi = +-pi). `points_per_curve` (at least 4) is shared by the pieces of a
/// curve.
[[nodiscard]] std::array<std::vector<std::vector<Vec2>>, 4> region_borders(int points_per_curve);

/// The paper's Figure 4: directions (phi, theta) that two adjacent usable readings leave possible,
/// from the exact segment of forces. `reading` is that of `sensel` (1..4), `next_reading` that of
/// sensel % 4 + 1; counts as the model has them, not below zero. From theta = pi/2 to the border of
/// the region, `points` (at least 2) at even steps of the force. A continuous polyline: phi is
/// unwrapped, its region's middle being in [-pi, pi]. Empty where both readings are zero.
[[nodiscard]] std::vector<Vec2> ambiguity_contour(int sensel, double reading, double next_reading,
                                                  int points);

}  // namespace pillarfield::viewer
