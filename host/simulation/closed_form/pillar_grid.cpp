#include "simulation/closed_form/pillar_grid.h"

#include <algorithm>
#include <cmath>

namespace pillarfield {

PillarGrid::Span PillarGrid::span_of(double low_mm, double high_mm, std::uint32_t count) const {
  const double last = count;
  const double low = std::clamp(std::floor(low_mm / pitch_ + last / 2), 0.0, last);
  const double high = std::clamp(std::ceil(high_mm / pitch_ + last / 2), low, last);
  return {static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high - low)};
}

PillarBox PillarGrid::box_around(PlaneVector centre, PlaneVector reach) const {
  const Span cols = span_of(centre.x - reach.x, centre.x + reach.x, cols_);
  // Rows count downwards.
  const Span rows = span_of(-centre.y - reach.y, -centre.y + reach.y, rows_);
  return {rows.first, cols.first, rows.count, cols.count};
}

}  // namespace pillarfield
