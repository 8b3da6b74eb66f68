#pragma once

#include <array>
#include <vector>

#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// The paper's Figure 3: curves over phi (x, -pi..pi) and theta (y, 0..pi/2) at which the reading
/// of sensel n = 1..4 (index 0..3) becomes zero: cos theta = sin theta cos(pi/4 (2n-1) - phi). A
/// curve exists where the cosine is not negative and may cross phi = +-pi, so it consists of pieces
/// in ascending phi, which begin and end on the diagram's edge. The pieces of a curve share
/// `points_per_curve` (at least 4) points.
[[nodiscard]] std::array<std::vector<std::vector<Vec2>>, 4> region_borders(int points_per_curve);

/// The paper's Figure 4: directions (phi, theta) of the feasible segment of two adjacent usable
/// readings, of `sensel` (1..4) and of sensel % 4 + 1, in counts, not negative. `points` (at least
/// 2) lie at even steps of force from theta = pi/2 to the border of the region. Phi is unwrapped,
/// the middle of the region in [-pi, pi]. Empty where both readings are zero.
[[nodiscard]] std::vector<Vec2> ambiguity_contour(int sensel, double reading, double next_reading,
                                                  int points);

}  // namespace pillarfield::viewer
