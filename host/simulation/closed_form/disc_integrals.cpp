#include "simulation/closed_form/disc_integrals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "base/wide.h"
#include "simulation/closed_form/arc.h"
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

PF_WIDE_INLINE PressureCorner pressure_corner(double x, double y) {
  x = std::clamp(x, -1.0, 1.0);
  y = std::clamp(y, -1.0, 1.0);
  const double height = std::sqrt(std::max(0.0, 1 - x * x - y * y));
  return {x, y, height, arc(y, height), arc(x, height), arc(x * y, height)};
}

/// Points clamped to the disc, y first, and the integrals of (C13).
struct SpinPoints {
  CarlsonLanes x;  ///< within the chord at height y
  CarlsonLanes y;
  CarlsonLanes beyond;  ///< signed distance by which x was clamped
  CarlsonLanes radius;
  CarlsonLanes height;      ///< sqrt(1 − r²)
  CarlsonLanes half_chord;  ///< sqrt(1 − y²), squared
  CarlsonLanes first;       ///< y² K of (C13)
  CarlsonLanes second;      ///< D of (C13)
};

PF_WIDE_INLINE void set_spin_points(const CarlsonLanes& x, const CarlsonLanes& y,
                                    SpinPoints& points) {
  // Keep the integrals finite at y = 0 and |y| = 1, where their factors vanish.
  constexpr double kLeastYSquared = 1e-24;
  constexpr double kLeastChord = 1e-30;
  CarlsonArguments at{};
  CarlsonLanes y_squared;
  for (std::size_t i = 0; i < kCarlsonLanes; ++i) {
    points.y[i] = std::clamp(y[i], -1.0, 1.0);
    points.half_chord[i] = (1 - points.y[i]) * (1 + points.y[i]);
    const double half_chord = std::sqrt(points.half_chord[i]);
    points.x[i] = std::clamp(x[i], -half_chord, half_chord);
    points.beyond[i] = x[i] - points.x[i];
    const double x_squared = points.x[i] * points.x[i];
    points.radius[i] = std::min(1.0, std::sqrt(x_squared + points.y[i] * points.y[i]));
    const double height_squared = std::max(0.0, points.half_chord[i] - x_squared);
    points.height[i] = std::sqrt(height_squared);
    y_squared[i] = std::max(points.y[i] * points.y[i], kLeastYSquared);
    const double chord = std::max(points.half_chord[i], kLeastChord);
    at.x[i] = y_squared[i] * height_squared;
    at.y[i] = (x_squared + y_squared[i]) * chord;
    at.z[i] = y_squared[i] * chord;
  }
  carlson_integrals(at, points.first, points.second);
  for (std::size_t i = 0; i < kCarlsonLanes; ++i) {
    points.first[i] *= y_squared[i] * points.x[i];
    points.second[i] *= y_squared[i] * points.x[i] * points.x[i] * points.x[i] / 3;
  }
}

PF_WIDE void sphere_spin(const CarlsonLanes& x, const CarlsonLanes& y, CarlsonLanes& values) {
  SpinPoints c{};
  set_spin_points(x, y, c);
  for (std::size_t i = 0; i < kCarlsonLanes; ++i) {
    const double elliptic = c.first[i] - (1 + c.y[i] * c.y[i]) * c.second[i];
    const double inside = c.x[i] * arc(c.radius[i], c.height[i]) +
                          c.x[i] * c.radius[i] * c.height[i] / 3 +
                          2 * c.half_chord[i] * elliptic / 3;
    values[i] = 3 / (4 * pi) * inside + 3.0 / 8 * c.beyond[i];
  }
}

PF_WIDE void punch_spin(const CarlsonLanes& x, const CarlsonLanes& y, CarlsonLanes& values) {
  SpinPoints c{};
  set_spin_points(x, y, c);
  for (std::size_t i = 0; i < kCarlsonLanes; ++i) {
    const double inside = c.x[i] * arc(c.radius[i], c.height[i]) - c.half_chord[i] * c.second[i];
    values[i] = inside / (2 * pi) + c.beyond[i] / 4;
  }
}

/// Calls a function of kCarlsonLanes points for all points.
template <class Lanes>
void in_lanes(std::span<const double> x, std::span<const double> y, std::span<double> values,
              Lanes lanes) {
  CarlsonLanes part_x{};
  CarlsonLanes part_y{};
  CarlsonLanes part;
  for (std::size_t first = 0; first < values.size(); first += kCarlsonLanes) {
    const std::size_t count = std::min(kCarlsonLanes, values.size() - first);
    std::copy_n(&x[first], count, part_x.begin());
    std::copy_n(&y[first], count, part_y.begin());
    lanes(part_x, part_y, part);
    std::copy_n(part.begin(), count, &values[first]);
  }
}

}  // namespace

PF_WIDE void sphere_pressure_corner(std::span<const double> x, std::span<const double> y,
                                    std::span<double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const PressureCorner c = pressure_corner(x[i], y[i]);
    const double volume = 2 * c.x * c.y * c.height + c.x * (3 - c.x * c.x) * c.angle_x +
                          c.y * (3 - c.y * c.y) * c.angle_y - 2 * c.angle_xy;
    values[i] = volume / (4 * pi);
  }
}

PF_WIDE void punch_pressure_corner(std::span<const double> x, std::span<const double> y,
                                   std::span<double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const PressureCorner c = pressure_corner(x[i], y[i]);
    values[i] = (c.x * c.angle_x + c.y * c.angle_y - c.angle_xy) / (2 * pi);
  }
}

void sphere_spin_corner(std::span<const double> x, std::span<const double> y,
                        std::span<double> values) {
  in_lanes(x, y, values, sphere_spin);
}

void punch_spin_corner(std::span<const double> x, std::span<const double> y,
                       std::span<double> values) {
  in_lanes(x, y, values, punch_spin);
}

}  // namespace pillarfield
