#include "simulation/closed_form/pillar_shares.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

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
  std::transform(x.begin(), x.end(), values.begin(), [=](double at) { return corner(at, y); });
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

Shares strip_shares(const PillarGrid& grid, const PillarBox& box, const Strip& strip) {
  Shares shares;
  shares.reserve(box.pillars());
  for (std::uint32_t row = box.first_row; row < box.first_row + box.rows; ++row) {
    const double top = grid.top_mm(row);
    const double bottom = grid.top_mm(row + 1);
    for (std::uint32_t col = box.first_col; col < box.first_col + box.cols; ++col) {
      const double left = grid.left_mm(col);
      const double right = grid.left_mm(col + 1);
      shares.push_back(line_share({on_strip(strip, left, bottom), on_strip(strip, right, bottom),
                                   on_strip(strip, right, top), on_strip(strip, left, top)},
                                  strip.half_width_mm, strip.length_mm));
    }
  }
  return shares;
}

}  // namespace pillarfield
