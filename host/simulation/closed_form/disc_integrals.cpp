#include "simulation/closed_form/disc_integrals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/closed_form/elliptic_integrals.h"

namespace pillarfield {
namespace {

using std::numbers::pi;

/// A corner clamped to the disc's bounding square, beyond which the corner functions of pressure
/// are constant, and the three angles of (C5) and (C7).
struct PressureCorner {
  double x;
  double y;
  double height;   ///< sqrt(1 − x² − y²), 0 outside the disc (C6)
  double angle_x;  ///< belongs to the strip along x
  double angle_y;
  double angle_xy;
};

PressureCorner pressure_corner(double x, double y) {
  x = std::clamp(x, -1.0, 1.0);
  y = std::clamp(y, -1.0, 1.0);
  const double height = std::sqrt(std::max(0.0, 1 - x * x - y * y));
  return {x, y, height, std::atan2(y, height), std::atan2(x, height), std::atan2(x * y, height)};
}

/// A point at height y clamped to the disc, and the integrals of (C13).
struct SpinCorner {
  double x;  ///< within the chord at height y
  double y;
  double beyond;  ///< signed distance by which x was clamped
  double radius;
  double height;      ///< sqrt(1 − r²)
  double half_chord;  ///< sqrt(1 − y²), squared
  double first;       ///< y² K of (C13)
  double second;      ///< D of (C13)
};

SpinCorner spin_corner(double x, double y) {
  const double half_chord_squared = std::max(0.0, (1 - y) * (1 + y));
  const double half_chord = std::sqrt(half_chord_squared);
  const double inside = std::clamp(x, -half_chord, half_chord);
  const double radius = std::min(1.0, std::hypot(inside, y));
  const double height = std::sqrt(std::max(0.0, half_chord_squared - inside * inside));
  SpinCorner corner{inside, y, x - inside, radius, height, half_chord_squared, 0, 0};
  if (inside == 0 || half_chord == 0) return corner;

  // Below this the limit y = 0 is exact in double precision.
  const double y_squared = y * y;
  if (y_squared < 1e-24) {
    corner.second = std::copysign(1 - height, inside);
    return corner;
  }
  const CarlsonIntegrals carlson =
      carlson_integrals(y_squared * height * height, radius * radius * half_chord_squared,
                        y_squared * half_chord_squared);
  corner.first = y_squared * inside * carlson.first;
  corner.second = y_squared * inside * inside * inside / 3 * carlson.second;
  return corner;
}

}  // namespace

double sphere_pressure_corner(double x, double y) {
  const PressureCorner c = pressure_corner(x, y);
  const double volume = 2 * c.x * c.y * c.height + c.x * (3 - c.x * c.x) * c.angle_x +
                        c.y * (3 - c.y * c.y) * c.angle_y - 2 * c.angle_xy;
  return volume / (4 * pi);
}

double punch_pressure_corner(double x, double y) {
  const PressureCorner c = pressure_corner(x, y);
  return (c.x * c.angle_x + c.y * c.angle_y - c.angle_xy) / (2 * pi);
}

double sphere_spin_corner(double x, double y) {
  if (std::abs(y) >= 1) return 3.0 / 8 * x;
  const SpinCorner c = spin_corner(x, y);
  const double elliptic = c.first - (1 + c.y * c.y) * c.second;
  const double inside = c.x * std::atan2(c.radius, c.height) + c.x * c.radius * c.height / 3 +
                        2 * c.half_chord * elliptic / 3;
  return 3 / (4 * pi) * inside + 3.0 / 8 * c.beyond;
}

double punch_spin_corner(double x, double y) {
  if (std::abs(y) >= 1) return x / 4;
  const SpinCorner c = spin_corner(x, y);
  const double inside = c.x * std::atan2(c.radius, c.height) - c.half_chord * c.second;
  return inside / (2 * pi) + c.beyond / 4;
}

}  // namespace pillarfield
