#include "simulation/closed_form/pillar_shares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "simulation/closed_form/line_integrals.h"

namespace pillarfield {
namespace {

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
