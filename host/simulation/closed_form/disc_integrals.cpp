#include "simulation/closed_form/disc_integrals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "base/wide.h"
#include "simulation/closed_form/arc.h"

namespace pillarfield {
namespace {

constexpr std::size_t kCarlsonLanes = 8;  ///< points at a time
using CarlsonLanes = std::array<double, kCarlsonLanes>;
struct CarlsonArguments {
  CarlsonLanes x;
  CarlsonLanes y;
  CarlsonLanes z;
};

/// R_F of arguments that nearly agree: Taylor series about their mean (DLMF 19.36.1).
PF_WIDE_INLINE double first_near_mean(double x, double y, double z) {
  const double mean = (x + y + z) / 3;
  const double u = 1 - x / mean;
  const double v = 1 - y / mean;
  const double w = -(u + v);
  const double e2 = u * v - w * w;
  const double e3 = u * v * w;
  return (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44) / std::sqrt(mean);
}

/// R_D of arguments that nearly agree (DLMF 19.36.2).
PF_WIDE_INLINE double second_near_mean(double x, double y, double z) {
  const double mean = (x + y + 3 * z) / 5;
  const double u = 1 - x / mean;
  const double v = 1 - y / mean;
  const double w = -(u + v) / 3;
  const double uv = u * v;
  const double ww = w * w;
  const double e2 = uv - 6 * ww;
  const double e3 = (3 * uv - 8 * ww) * w;
  const double e4 = 3 * (uv - ww) * ww;
  const double e5 = uv * ww * w;
  const double series =
      1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 - 9 * e2 * e3 / 52 + 3 * e5 / 26;
  return series / (mean * std::sqrt(mean));
}

/// True if the series have converged in all lanes: their error is the sixth power of the spread.
PF_WIDE_INLINE bool nearly_agree(const CarlsonArguments& at) {
  constexpr double kSpread = 3e-3;
  double excess = 0;
  for (std::size_t i = 0; i < kCarlsonLanes; ++i) {
    const double most = std::max(at.x[i], std::max(at.y[i], at.z[i]));
    const double least = std::min(at.x[i], std::min(at.y[i], at.z[i]));
    excess = std::max(excess, most - (1 + kSpread) * least);
  }
  return excess <= 0;
}

/// Carlson's symmetric elliptic integrals,
///
///     first  = R_F(x, y, z) = 1/2 ∫ dt / sqrt((t+x)(t+y)(t+z)),           t from 0 to infinity
///     second = R_D(x, y, z) = 3/2 ∫ dt / (sqrt((t+x)(t+y)(t+z)) (t+z))
///
/// by duplication until the arguments nearly agree, and a series about their mean (B. C. Carlson,
/// Numerical Algorithms 10 (1995) 13-26).
/// Requires x, y >= 0, at most one of them zero, and z > 0. Relative error: 1e-14.
PF_WIDE void carlson_integrals(CarlsonArguments at, CarlsonLanes& first, CarlsonLanes& second) {
  CarlsonLanes sum{};
  double weight = 1;
  while (!nearly_agree(at)) {
    for (std::size_t i = 0; i < kCarlsonLanes; ++i) {
      const double root_x = std::sqrt(at.x[i]);
      const double root_y = std::sqrt(at.y[i]);
      const double root_z = std::sqrt(at.z[i]);
      const double lambda = root_x * root_y + root_y * root_z + root_z * root_x;
      sum[i] += weight / (root_z * (at.z[i] + lambda));
      at.x[i] = (at.x[i] + lambda) / 4;
      at.y[i] = (at.y[i] + lambda) / 4;
      at.z[i] = (at.z[i] + lambda) / 4;
    }
    weight /= 4;
  }
  for (std::size_t i = 0; i < kCarlsonLanes; ++i) {
    first[i] = first_near_mean(at.x[i], at.y[i], at.z[i]);
    second[i] = 3 * sum[i] + weight * second_near_mean(at.x[i], at.y[i], at.z[i]);
  }
}

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
