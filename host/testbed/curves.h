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

/// The inclination beyond which sensel 1, 2, 3 or 4 lifts, found as the zero of its reading: the
/// paper's equation (3); pi/2 where it does not lift at all. Within 1e-15.
[[nodiscard]] double border_theta(int sensel, double phi_rad);

inline constexpr double kPi = std::numbers::pi;

/// A region of Figure 3 and a place within. Behind the point of its name, which is the paper's, are
/// the sensels that are not usable.
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

/// The four points that are region 4.
inline constexpr std::array<RegionLabel, 4> kCornerLabels = {{
    {"4.124", {kPi / 2, kPi / 4}},
    {"4.123", {kPi / 2, 3 * kPi / 4}},
    {"4.234", {kPi / 2, 5 * kPi / 4}},
    {"4.134", {kPi / 2, 7 * kPi / 4}},
}};

/// The directions for which the two readings of region 3.12 have the ratio V3 / V4 = `ratio` > 0,
/// from theta = pi/2 to the region's border: a contour of the paper's equation (5). `points` >= 2.
[[nodiscard]] std::vector<Angles> contour(double ratio, int points);

/// Where on that contour an estimator puts the force: the paper's half way in theta, or the segment
/// point.
[[nodiscard]] Angles point_on_contour(double ratio, Estimator estimator);

/// Half of what theta and phi range over along that contour, rad; the same for any two adjacent
/// sensels.
[[nodiscard]] Angles half_widths(double ratio);

}  // namespace pillarfield::testbed
