#include "simulation/closed_form/pillar_shares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

#include "base/wide.h"
#include "simulation/closed_form/arc.h"

namespace pillarfield {
namespace {

/// A point in the frame of a line contact: `across` its axis and `along` it, from its centre, mm.
struct LinePoint {
  double across;
  double along;
};

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

/// The force on a cell under a line contact of load 1: the integral of
/// p = 2 sqrt(1 − across²/a²) / (pi a L) over the part of the cell where |across| <= a = half_width
/// and |along| <= L/2, by Green's theorem (C17)-(C19). `cell` has its corners counter-clockwise,
/// at any rotation. Zero outside the contact. Error: 1e-9. Cost: about 0.1 µs.
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

/// values[i] = ∫₀^u G of (C18) at u[i], in half widths. Error: 1e-15.
PF_WIDE void integrals_of_load(std::span<const double> u, std::span<double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = integral_of_load_to(u[i]);
}

/// Means of G over [from[i], to[i]], given the integrals at both ends (C19). The intervals have one
/// length, positive or negative.
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

/// The edges between the columns (x) and rows (y) of a box, in radii from the centre of a disc.
struct Edges {
  std::vector<double> x;  ///< rising
  std::vector<double> y;  ///< falling
};

Edges edges_of(const PillarGrid& grid, const PillarBox& box, const Disc& disc) {
  Edges edges;
  for (std::uint32_t col = 0; col <= box.cols; ++col) {
    edges.x.push_back((grid.left_mm(box.first_col + col) - disc.centre_mm.x) / disc.radius_mm);
  }
  for (std::uint32_t row = 0; row <= box.rows; ++row) {
    edges.y.push_back((grid.top_mm(box.first_row + row) - disc.centre_mm.y) / disc.radius_mm);
  }
  return edges;
}

std::vector<double> corners_along(const std::vector<double>& x, double y, CornerFunction corner) {
  std::vector<double> values(x.size());
  corner(x, std::vector<double>(x.size(), y), values);
  return values;
}

/// Distance from zero to the interval [low, high].
double distance_to(double low, double high) { return std::max({0.0, low, -high}); }

bool meets_disc(const Edges& edges, std::size_t row, std::size_t col) {
  const double dx = distance_to(edges.x[col], edges.x[col + 1]);
  const double dy = distance_to(edges.y[row + 1], edges.y[row]);
  return dx * dx + dy * dy < 1;
}

/// A point of the skin in the strip's frame.
LinePoint on_strip(const Strip& strip, double x_mm, double y_mm) {
  const double dx = x_mm - strip.centre_mm.x;
  const double dy = y_mm - strip.centre_mm.y;
  return {dx * strip.direction.x + dy * strip.direction.y,
          dy * strip.direction.x - dx * strip.direction.y};
}

/// A rectangle of the skin, mm.
struct Rectangle {
  double left;
  double bottom;
  double right;
  double top;
};

/// Nodes and weights of Gauss's rule on [0, 1].
struct GaussNode {
  double at;
  double weight;
};
constexpr std::array<GaussNode, 8> kGauss = {{
    {0.0198550717512319, 0.0506142681451881},
    {0.1016667612931866, 0.1111905172266872},
    {0.2372337950418355, 0.1568533229389436},
    {0.4082826787521751, 0.1813418916891810},
    {0.5917173212478249, 0.1813418916891810},
    {0.7627662049581645, 0.1568533229389436},
    {0.8983332387068134, 0.1111905172266872},
    {0.9801449282487681, 0.0506142681451881},
}};

/// The interval [low, high] within [from, to].
struct Clipped {
  Clipped(double low, double high, double from, double to)
      : begin(std::clamp(from, low, high)), end(std::clamp(to, low, high)) {}
  double begin;
  double end;
};

/// First moments about a cell's middle of the pressure whose integral over a rectangle is `load`,
/// zero outside `contact`. With F(x), the load to the left of x: ∬ p (x − middle) =
/// F(right) (right − left)/2 − ∫ F.
template <class Load>
PlaneVector cell_moment(const Rectangle& cell, const Rectangle& contact, const Load& load) {
  const double whole = load(cell);
  if (!(whole > 0)) return {0, 0};
  const Clipped x(cell.left, cell.right, contact.left, contact.right);
  const Clipped y(cell.bottom, cell.top, contact.bottom, contact.top);
  PlaneVector mean = {0, 0};
  for (const auto& [at, weight] : kGauss) {
    mean.x += weight * load({cell.left, cell.bottom, std::lerp(x.begin, x.end, at), cell.top});
    mean.y += weight * load({cell.left, cell.bottom, cell.right, std::lerp(y.begin, y.end, at)});
  }
  return {whole * (x.end - (cell.left + cell.right) / 2) - (x.end - x.begin) * mean.x,
          whole * (y.end - (cell.bottom + cell.top) / 2) - (y.end - y.begin) * mean.y};
}

template <class Load>
ShareMoments box_moments(const PillarGrid& grid, const PillarBox& box, const Rectangle& contact,
                         const Load& load) {
  ShareMoments moments;
  moments.reserve(box.pillars());
  for (std::uint32_t row = box.first_row; row < box.first_row + box.rows; ++row) {
    for (std::uint32_t col = box.first_col; col < box.first_col + box.cols; ++col) {
      const Rectangle cell = {grid.left_mm(col), grid.top_mm(row + 1), grid.left_mm(col + 1),
                              grid.top_mm(row)};
      moments.push_back(cell_moment(cell, contact, load));
    }
  }
  return moments;
}

Rectangle around(PlaneVector centre, double x, double y) {
  return {centre.x - x, centre.y - y, centre.x + x, centre.y + y};
}

/// The integral of a strip's pressure over a rectangle.
double strip_share(const Strip& strip, const Rectangle& at) {
  return line_share({on_strip(strip, at.left, at.bottom), on_strip(strip, at.right, at.bottom),
                     on_strip(strip, at.right, at.top), on_strip(strip, at.left, at.top)},
                    strip.half_width_mm, strip.length_mm);
}

/// A line of corners on a strip, and the integrals of (C19) at them.
struct StripLine {
  StripLine(const PillarGrid& grid, const PillarBox& box, const Strip& strip, std::uint32_t row)
      : across(box.cols + 1), along(across.size()), integral(across.size()), mean(box.cols) {
    for (std::uint32_t i = 0; i <= box.cols; ++i) {
      const LinePoint point =
          on_strip(strip, grid.left_mm(box.first_col + i), grid.top_mm(box.first_row + row));
      across[i] = point.across / strip.half_width_mm;
      along[i] = point.along;
    }
    integrals_of_load(across, integral);
    const auto from = [](const std::vector<double>& values) {
      return std::span(values).first(values.size() - 1);
    };
    const auto to = [](const std::vector<double>& values) { return std::span(values).subspan(1); };
    means_of_load(from(across), from(integral), to(across), to(integral), mean);
  }

  std::vector<double> across;  ///< in half widths
  std::vector<double> along;
  std::vector<double> integral;
  std::vector<double> mean;  ///< of the edges between neighbours
};

/// A row of cells on a strip.
class StripRow {
 public:
  StripRow(const StripLine& above, const StripLine& below, double length_mm)
      : above_(above), below_(below), length_mm_(length_mm), mean_(above.across.size()) {
    means_of_load(below.across, below.integral, above.across, above.integral, mean_);
  }

  enum class Place : std::uint8_t { outside, inside, at_an_end };

  [[nodiscard]] Place place(std::size_t col) const {
    const auto [inner, outer] = std::minmax(
        {above_.across[col], above_.across[col + 1], below_.across[col], below_.across[col + 1]});
    const auto [first, last] = std::minmax(
        {above_.along[col], above_.along[col + 1], below_.along[col], below_.along[col + 1]});
    if (inner >= 1 || outer <= -1) return Place::outside;
    if (first >= length_mm_ / 2 || last <= -length_mm_ / 2) return Place::outside;
    const bool inside = first >= -length_mm_ / 2 && last <= length_mm_ / 2;
    return inside ? Place::inside : Place::at_an_end;
  }

  /// (C19) of a cell inside.
  [[nodiscard]] double share(std::size_t col) const {
    const double horizontal = below_.mean[col] * (below_.along[col + 1] - below_.along[col]) -
                              above_.mean[col] * (above_.along[col + 1] - above_.along[col]);
    const double vertical = mean_[col + 1] * (above_.along[col + 1] - below_.along[col + 1]) -
                            mean_[col] * (above_.along[col] - below_.along[col]);
    return std::max(0.0, (horizontal + vertical) / length_mm_);
  }

 private:
  const StripLine& above_;
  const StripLine& below_;
  double length_mm_;
  std::vector<double> mean_;  ///< of the edges from below to above
};

}  // namespace

Shares disc_shares(const PillarGrid& grid, const PillarBox& box, const Disc& disc,
                   CornerFunction corner) {
  const Edges edges = edges_of(grid, box, disc);
  Shares shares;
  shares.reserve(box.pillars());
  std::vector<double> above = corners_along(edges.x, edges.y.front(), corner);
  for (std::size_t row = 0; row < box.rows; ++row) {
    std::vector<double> below = corners_along(edges.x, edges.y[row + 1], corner);
    for (std::size_t col = 0; col < box.cols; ++col) {
      const double share = (above[col + 1] - above[col]) - (below[col + 1] - below[col]);
      shares.push_back(meets_disc(edges, row, col) ? share : 0);
    }
    above.swap(below);
  }
  return shares;
}

ShareMoments disc_moments(const PillarGrid& grid, const PillarBox& box, const Disc& disc,
                          CornerFunction corner) {
  const double scale = 1 / disc.radius_mm;
  const Rectangle contact = around(disc.centre_mm, disc.radius_mm, disc.radius_mm);
  return box_moments(grid, box, contact, [&](const Rectangle& at) {
    const double x0 = (at.left - disc.centre_mm.x) * scale;
    const double x1 = (at.right - disc.centre_mm.x) * scale;
    const double y0 = (at.bottom - disc.centre_mm.y) * scale;
    const double y1 = (at.top - disc.centre_mm.y) * scale;
    std::array<double, 4> at_corner{};
    corner(std::array{x1, x0, x1, x0}, std::array{y1, y1, y0, y0}, at_corner);
    return (at_corner[0] - at_corner[1]) - (at_corner[2] - at_corner[3]);
  });
}

Shares strip_shares(const PillarGrid& grid, const PillarBox& box, const Strip& strip) {
  Shares shares;
  shares.reserve(box.pillars());
  StripLine above(grid, box, strip, 0);
  for (std::uint32_t row = 0; row < box.rows; ++row) {
    StripLine below(grid, box, strip, row + 1);
    const StripRow cells(above, below, strip.length_mm);
    for (std::uint32_t i = 0; i < box.cols; ++i) {
      const StripRow::Place place = cells.place(i);
      double share = place == StripRow::Place::inside ? cells.share(i) : 0;
      if (place == StripRow::Place::at_an_end) {
        const std::uint32_t col = box.first_col + i;
        share = strip_share(strip, {grid.left_mm(col), grid.top_mm(box.first_row + row + 1),
                                    grid.left_mm(col + 1), grid.top_mm(box.first_row + row)});
      }
      shares.push_back(share);
    }
    std::swap(above, below);
  }
  return shares;
}

ShareMoments strip_moments(const PillarGrid& grid, const PillarBox& box, const Strip& strip) {
  const PlaneVector d = {std::abs(strip.direction.x), std::abs(strip.direction.y)};
  const double along = strip.length_mm / 2;
  const Rectangle contact = around(strip.centre_mm, strip.half_width_mm * d.x + along * d.y,
                                   strip.half_width_mm * d.y + along * d.x);
  return box_moments(grid, box, contact,
                     [&](const Rectangle& at) { return strip_share(strip, at); });
}

}  // namespace pillarfield
