#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pillarfield/skin.h"
#include "simulation/closed_form/pillar_grid.h"

namespace pillarfield {

/// Cells along a pillar's edge; tractions are constant on a cell.
inline constexpr std::int64_t kCellsPerPillar = 4;

/// A rectangle of cells. Rows and columns count from the top left corner of the skin and may lie
/// beyond it.
struct CellBox {
  std::int64_t first_row = 0;
  std::int64_t first_col = 0;
  std::int64_t rows = 0;
  std::int64_t cols = 0;

  [[nodiscard]] bool empty() const { return rows <= 0 || cols <= 0; }
  [[nodiscard]] std::size_t cells() const { return static_cast<std::size_t>(rows * cols); }
  [[nodiscard]] std::int64_t end_row() const { return first_row + rows; }
  [[nodiscard]] std::int64_t end_col() const { return first_col + cols; }

  /// True if `other` lies within; an empty box lies in any.
  [[nodiscard]] bool holds(const CellBox& other) const {
    return other.empty() || (other.first_row >= first_row && other.end_row() <= end_row() &&
                             other.first_col >= first_col && other.end_col() <= end_col());
  }
};

/// The smallest box that contains both.
[[nodiscard]] inline CellBox hull(const CellBox& a, const CellBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const std::int64_t row = std::min(a.first_row, b.first_row);
  const std::int64_t col = std::min(a.first_col, b.first_col);
  return {row, col, std::max(a.end_row(), b.end_row()) - row,
          std::max(a.end_col(), b.end_col()) - col};
}

/// The intersection; empty if they are disjoint.
[[nodiscard]] inline CellBox intersection(const CellBox& a, const CellBox& b) {
  const std::int64_t row = std::max(a.first_row, b.first_row);
  const std::int64_t col = std::max(a.first_col, b.first_col);
  return {row, col, std::max<std::int64_t>(0, std::min(a.end_row(), b.end_row()) - row),
          std::max<std::int64_t>(0, std::min(a.end_col(), b.end_col()) - col)};
}

/// A value per cell of a box, row by row.
struct CellField {
  CellField() = default;
  explicit CellField(const CellBox& over) : box(over), values(over.cells(), 0.0) {}

  [[nodiscard]] std::size_t index(std::int64_t row, std::int64_t col) const {
    return static_cast<std::size_t>((row - box.first_row) * box.cols + col - box.first_col);
  }

  CellBox box;
  std::vector<double> values;
};

/// `field` on another box, zero outside its own.
[[nodiscard]] inline CellField on_box(const CellField& field, const CellBox& box) {
  CellField moved(box);
  const CellBox common = intersection(field.box, box);
  for (std::int64_t row = common.first_row; row < common.end_row(); ++row) {
    if (common.cols == 0) break;
    std::copy_n(&field.values[field.index(row, common.first_col)], common.cols,
                &moved.values[moved.index(row, common.first_col)]);
  }
  return moved;
}

/// The smallest box of the cells that satisfy `condition(value)`.
template <class Condition>
[[nodiscard]] CellBox box_where(const CellField& field, Condition condition) {
  CellBox box;
  std::size_t cell = 0;
  for (std::int64_t row = field.box.first_row; row < field.box.end_row(); ++row) {
    for (std::int64_t col = field.box.first_col; col < field.box.end_col(); ++col, ++cell) {
      if (condition(field.values[cell])) box = hull(box, {row, col, 1, 1});
    }
  }
  return box;
}

/// The cells of a skin, in millimetres from the skin's centre, x right and y up.
class CellGrid {
 public:
  explicit CellGrid(const Skin& skin)
      : pillar_rows_(skin.element_rows()),
        pillar_cols_(skin.element_cols()),
        cell_mm_(skin.element_pitch_mm().col_mm / static_cast<double>(kCellsPerPillar)) {}

  [[nodiscard]] double cell_mm() const { return cell_mm_; }
  /// Place of a cell's centre.
  [[nodiscard]] double x_mm(std::int64_t col) const {
    return (static_cast<double>(col) + 0.5 - half(pillar_cols_)) * cell_mm_;
  }
  [[nodiscard]] double y_mm(std::int64_t row) const {
    return (half(pillar_rows_) - static_cast<double>(row) - 0.5) * cell_mm_;
  }
  /// The cells whose centres lie within centre ± reach, and one more on each side.
  [[nodiscard]] CellBox box_around(PlaneVector centre, PlaneVector reach) const;

 private:
  [[nodiscard]] static double half(std::uint32_t pillars) {
    return pillars / 2.0 * static_cast<double>(kCellsPerPillar);
  }

  std::uint32_t pillar_rows_;
  std::uint32_t pillar_cols_;
  double cell_mm_;
};

inline CellBox CellGrid::box_around(PlaneVector centre, PlaneVector reach) const {
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
