#include "simulation/indenter/cells.h"

#include <cmath>

namespace pillarfield {

CellBox CellGrid::box_around(PlaneVector centre, PlaneVector reach) const {
  const auto cell = [this](double from_edge_mm) {
    return static_cast<std::int64_t>(std::floor(from_edge_mm / cell_mm_));
  };
  const double left = centre.x + half(pillar_cols_) * cell_mm_;
  const double top = half(pillar_rows_) * cell_mm_ - centre.y;
  const CellBox box = {cell(top - reach.y) - 1, cell(left - reach.x) - 1, 0, 0};
  return {box.first_row, box.first_col, cell(top + reach.y) + 2 - box.first_row,
          cell(left + reach.x) + 2 - box.first_col};
}

}  // namespace pillarfield
