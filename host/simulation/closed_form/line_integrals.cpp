#include "simulation/closed_form/line_integrals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "base/wide.h"
#include "simulation/closed_form/arc.h"

namespace pillarfield {
namespace {

using std::numbers::pi;

/// A convex polygon: a cell cut by two half planes, with spare corners for rounding.
struct Polygon {
  std::array<LinePoint, 9> corners{};
  std::size_t size = 0;

  void add(LinePoint point) { corners[size++] = point; }
  [[nodiscard]] std::span<const LinePoint> points() const { return {corners.data(), size}; }
};

/// The part of the polygon with sign·along <= limit.
Polygon clip(std::span<const LinePoint> points, double sign, double limit) {
  Polygon inside;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LinePoint from = points[i];
    const LinePoint to = points[(i + 1) % points.size()];
    const double from_excess = sign * from.along - limit;
    const double to_excess = sign * to.along - limit;
    if (from_excess <= 0) inside.add(from);
    if ((from_excess < 0 && to_excess > 0) || (from_excess > 0 && to_excess < 0)) {
      const double fraction = from_excess / (from_excess - to_excess);
      inside.add({from.across + fraction * (to.across - from.across), sign * limit});
    }
  }
  return inside;
}

/// The load between the axis and u half widths from it, per length: −1/2 to 1/2 (C18).
PF_WIDE_INLINE double load_to(double u) {
  const double inside = std::clamp(u, -1.0, 1.0);
  const double height = std::sqrt(1 - inside * inside);
  return (inside * height + arc(inside, height)) / pi;
}

/// The integral of load_to from 0 to u (C18).
PF_WIDE_INLINE double integral_of_load_to(double u) {
  const double inside = std::min(1.0, std::abs(u));
  const double height = std::sqrt(1 - inside * inside);
  const double integral =
      inside * arc(inside, height) + height - height * height * height / 3 - 2.0 / 3;
  return integral / pi + (std::abs(u) - inside) / 2;
}

/// Below it the quotient of (C19) loses digits, and the value in the middle serves.
constexpr double kShortEdge = 1e-6;

/// Mean of load_to over [u0, u1].
double mean_load_to(double u0, double u1) {
  if (std::abs(u1 - u0) < kShortEdge) return load_to((u0 + u1) / 2);
  return (integral_of_load_to(u1) - integral_of_load_to(u0)) / (u1 - u0);
}

bool misses(const std::array<LinePoint, 4>& cell, double half_width) {
  const auto [least, most] = std::minmax_element(
      cell.begin(), cell.end(), [](LinePoint a, LinePoint b) { return a.across < b.across; });
  return least->across >= half_width || most->across <= -half_width;
}

}  // namespace

double line_share(const std::array<LinePoint, 4>& cell, double half_width, double length) {
  if (misses(cell, half_width)) return 0;
  const Polygon below = clip(cell, 1, length / 2);
  const Polygon within = clip(below.points(), -1, length / 2);
  const std::span<const LinePoint> points = within.points();
  double share = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LinePoint from = points[i];
    const LinePoint to = points[(i + 1) % points.size()];
    share += mean_load_to(from.across / half_width, to.across / half_width) *
             (to.along - from.along) / length;
  }
  return std::max(0.0, share);
}

PF_WIDE void integrals_of_load(std::span<const double> u, std::span<double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = integral_of_load_to(u[i]);
}

PF_WIDE void means_of_load(std::span<const double> from, std::span<const double> from_integral,
                           std::span<const double> to, std::span<const double> to_integral,
                           std::span<double> values) {
  if (values.empty()) return;
  if (std::abs(to[0] - from[0]) < kShortEdge) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = load_to((from[i] + to[i]) / 2);
    return;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = (to_integral[i] - from_integral[i]) / (to[i] - from[i]);
  }
}

}  // namespace pillarfield
