#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "testbed/testbed.h"

/// The curves of the paper's figures, computed by kernels/pillar.
namespace pillarfield::testbed {

/// A direction from which a force comes, rad.
struct Angles {
  double theta;
  double phi;
};

/// Inclination, rad, above which sensel 1, 2, 3 or 4 is inactive: the zero of its reading by
/// bisection, equation (3) of the paper; pi/2 where it is always active. Within 1e-15.
[[nodiscard]] double border_theta(int sensel, double phi_rad);

inline constexpr double kPi = std::numbers::pi;

/// Name and place of a region in Figure 3. The digits after the point are its inactive sensels.
struct RegionLabel {
  const char* name;
  Angles place;
};
inline constexpr std::array<RegionLabel, 10> kRegionLabels = {{
    {"1", {0.36, kPi}},
    {"2.1", {1.12, kPi / 4}},
    {"2.2", {1.12, 3 * kPi / 4}},
    {"2.3", {1.12, 5 * kPi / 4}},
    {"2.4", {1.12, 7 * kPi / 4}},
    {"3.12", {1.38, kPi / 2}},
    {"3.23", {1.38, kPi}},
    {"3.34", {1.38, 3 * kPi / 2}},
    {"3.14", {1.38, 0.3}},
    {"3.14", {1.38, 2 * kPi - 0.3}},
}};

/// The four points of region 4.
inline constexpr std::array<RegionLabel, 4> kCornerLabels = {{
    {"4.124", {kPi / 2, kPi / 4}},
    {"4.123", {kPi / 2, 3 * kPi / 4}},
    {"4.234", {kPi / 2, 5 * kPi / 4}},
    {"4.134", {kPi / 2, 7 * kPi / 4}},
}};

/// Returns the directions of region 3.12 with V3 / V4 = `ratio` > 0, from theta = pi/2 to the
/// border of the region: a contour of equation (5) of the paper. `points` >= 2.
[[nodiscard]] std::vector<Angles> contour(double ratio, int points);

/// Returns the estimate on that contour: midpoint in theta (paper) or segment point (direct).
[[nodiscard]] Angles point_on_contour(double ratio, Estimator estimator);

/// Returns half the range of theta and phi along that contour, rad; equal for all pairs of adjacent
/// sensels.
[[nodiscard]] Angles half_widths(double ratio);

}  // namespace pillarfield::testbed
