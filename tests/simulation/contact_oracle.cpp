#include "contact_oracle.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace pillarfield::oracle {
namespace {

using std::numbers::pi;

Traction operator+(Traction a, Traction b) {
  return {a.x + b.x, a.y + b.y, a.pressure + b.pressure};
}
Traction operator*(double factor, Traction t) {
  return {factor * t.x, factor * t.y, factor * t.pressure};
}

/// A node in (−1, 1) of the double exponential (tanh-sinh) rule, and its weight.
struct Node {
  double at;
  double weight;
};

std::vector<Node> double_exponential_rule() {
  std::vector<Node> nodes;
  const double step = 0.06;
  for (int i = -60; i <= 60; ++i) {
    const double t = pi / 2 * std::sinh(i * step);
    const double slope = pi / 2 * std::cosh(i * step) / std::pow(std::cosh(t), 2);
    if (slope > 1e-17) nodes.push_back({std::tanh(t), step * slope});
  }
  return nodes;
}

/// By that rule, to which singularities at the ends do no harm.
template <class Function>
Traction integrate(double low, double high, Function f) {
  static const std::vector<Node> nodes = double_exponential_rule();
  Traction sum;
  if (!(high > low)) return sum;
  const double half = (high - low) / 2;
  for (const Node& node : nodes) sum = sum + half * node.weight * f(low + half * (1 + node.at));
  return sum;
}

/// The same over pieces between the breaks that lie inside.
template <class Function>
Traction integrate_pieces(double low, double high, std::vector<double> breaks, Function f) {
  Traction sum;
  std::sort(breaks.begin(), breaks.end());
  for (const double at : breaks) {
    if (at <= low || at >= high) continue;
    sum = sum + integrate(low, at, f);
    low = at;
  }
  return sum + integrate(low, high, f);
}

double root(double value) { return std::sqrt(std::max(0.0, value)); }

struct Indenter {
  const ClosedFormContact& contact;
  double load;
  double radius;

  [[nodiscard]] double pressure(double r_squared) const {
    if (r_squared >= radius * radius) return 0;
    if (contact.shape == ContactShape::flat_punch) {
      return load / (2 * pi * radius * std::sqrt(radius * radius - r_squared));
    }
    const double p0 = contact.shape == ContactShape::sphere
                          ? 3 * load / (2 * pi * radius * radius)
                          : 2 * load / (pi * radius * contact.length_mm);
    return p0 * root(1 - r_squared / (radius * radius));
  }
};

/// The point is relative to the contact's centre.
Traction traction(const Indenter& indenter, double x, double y) {
  const ClosedFormContact& c = indenter.contact;
  const double angle = c.direction_deg * pi / 180;
  const double across = x * std::cos(angle) + y * std::sin(angle);
  const bool cylinder = c.shape == ContactShape::cylinder;
  const double r_squared = cylinder ? across * across : x * x + y * y;
  const double p = indenter.pressure(r_squared);
  if (c.motion == ContactMotion::press) return {0, 0, p};
  if (c.motion == ContactMotion::spin) {
    const double r = std::hypot(x, y);
    const double q = (c.clockwise ? -1 : 1) * c.friction * p / std::max(r, 1e-300);
    return {-q * y, q * x, p};
  }
  double q = c.friction * p;
  const double held = 1 - c.tangential_ratio;
  if (c.motion == ContactMotion::partial_slip) {
    // Mindlin: q'' = −(c/a) mu p0 sqrt(1 − r²/c²) where r <= c
    const double stick = indenter.radius * std::cbrt(held);
    const double p0 = 3 * indenter.load / (2 * pi * indenter.radius * indenter.radius);
    q -= c.friction * p0 * stick / indenter.radius * root(1 - r_squared / (stick * stick));
  }
  if (c.motion == ContactMotion::roll) {
    // Carter: the ellipse of the stick zone, shifted to the leading edge
    const double stick = indenter.radius * std::sqrt(held);
    const double p0 = 2 * indenter.load / (pi * indenter.radius * c.length_mm);
    const double from_middle = across - (indenter.radius - stick);
    q -= c.friction * p0 * stick / indenter.radius *
         root(1 - from_middle * from_middle / (stick * stick));
  }
  return {q * std::cos(angle), q * std::sin(angle), p};
}

Traction force_on_disc_cell(const Indenter& indenter, const Cell& cell) {
  const double a = indenter.radius;
  const double stick = a * std::cbrt(1 - indenter.contact.tangential_ratio);
  const auto along_y = [&](double x) {
    const double h = root(a * a - x * x);
    const double s = root(stick * stick - x * x);
    return integrate_pieces(std::max(cell.y0, -h), std::min(cell.y1, h), {-s, 0, s},
                            [&](double y) { return traction(indenter, x, y); });
  };
  std::vector<double> breaks = {0, stick, -stick};
  for (const double radius : {a, stick}) {
    for (const double y : {cell.y0, cell.y1}) {
      breaks.push_back(root(radius * radius - y * y));
      breaks.push_back(-breaks.back());
    }
  }
  return integrate_pieces(std::max(cell.x0, -a), std::min(cell.x1, a), breaks, along_y);
}

/// The interval of x in which |slope·x + offset| <= limit, cut with [low, high].
void cut(double slope, double offset, double limit, double& low, double& high) {
  if (std::abs(slope) < 1e-12) {
    if (std::abs(offset) > limit) high = low;
    return;
  }
  const double first = (-limit - offset) / slope;
  const double second = (limit - offset) / slope;
  low = std::max(low, std::min(first, second));
  high = std::min(high, std::max(first, second));
}

/// Lines along x, each integrated exactly enough; across them the midpoint rule.
Traction force_on_strip_cell(const Indenter& indenter, const Cell& cell) {
  const double angle = indenter.contact.direction_deg * pi / 180;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double stick = indenter.radius * std::sqrt(1 - indenter.contact.tangential_ratio);
  constexpr int kLines = 4000;
  Traction sum;
  for (int i = 0; i < kLines; ++i) {
    const double y = cell.y0 + (cell.y1 - cell.y0) * (i + 0.5) / kLines;
    double low = cell.x0;
    double high = cell.x1;
    cut(c, s * y, indenter.radius, low, high);
    cut(-s, c * y, indenter.contact.length_mm / 2, low, high);
    const double kink = std::abs(c) < 1e-12 ? 0 : (indenter.radius - 2 * stick - s * y) / c;
    const auto f = [&](double x) { return traction(indenter, x, y); };
    sum = sum + (cell.y1 - cell.y0) / kLines * integrate_pieces(low, high, {kink}, f);
  }
  return sum;
}

}  // namespace

Traction force_on_cell(const ClosedFormContact& contact, const ContactKey& state,
                       const Cell& cell) {
  const double growth = state.load_n / contact.reference_load_n;
  double radius = contact.contact_radius_mm;
  if (contact.shape == ContactShape::sphere) radius *= std::cbrt(growth);
  if (contact.shape == ContactShape::cylinder) radius *= std::sqrt(growth);
  const Indenter indenter{contact, state.load_n, radius};
  const Cell centred{cell.x0 - state.x_mm, cell.x1 - state.x_mm, cell.y0 - state.y_mm,
                     cell.y1 - state.y_mm};
  return contact.shape == ContactShape::cylinder ? force_on_strip_cell(indenter, centred)
                                                 : force_on_disc_cell(indenter, centred);
}

}  // namespace pillarfield::oracle
