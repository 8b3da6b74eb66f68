#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pillarfield {

/// A place or direction in the plane of the skin, + right and + up.
struct PlaneVector {
  double x;
  double y;
};

/// A rectangle of pillars.
struct PillarBox {
  std::uint32_t first_row;
  std::uint32_t first_col;
  std::uint32_t rows;
  std::uint32_t cols;

  [[nodiscard]] std::size_t pillars() const { return std::size_t{rows} * cols; }
};

/// The square cells of a patch's pillars, in millimetres from the patch's centre.
class PillarGrid {
 public:
  PillarGrid(std::uint32_t rows, std::uint32_t cols, double pitch_mm)
      : rows_(rows), cols_(cols), pitch_(pitch_mm) {}

  [[nodiscard]] double left_mm(std::uint32_t col) const { return (col - cols_ / 2.0) * pitch_; }
  [[nodiscard]] double top_mm(std::uint32_t row) const { return (rows_ / 2.0 - row) * pitch_; }

  /// The pillars of the patch that the rectangle centre ± reach touches.
  [[nodiscard]] PillarBox box_around(PlaneVector centre, PlaneVector reach) const;

 private:
  struct Span {
    std::uint32_t first;
    std::uint32_t count;
  };
  [[nodiscard]] Span span_of(double low_mm, double high_mm, std::uint32_t count) const;

  std::uint32_t rows_;
  std::uint32_t cols_;
  double pitch_;
};

inline PillarGrid::Span PillarGrid::span_of(double low_mm, double high_mm,
                                            std::uint32_t count) const {
  const double last = count;
  const double low = std::clamp(std::floor(low_mm / pitch_ + last / 2), 0.0, last);
  const double high = std::clamp(std::ceil(high_mm / pitch_ + last / 2), low, last);
  return {static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high - low)};
}

inline PillarBox PillarGrid::box_around(PlaneVector centre, PlaneVector reach) const {
  const Span cols = span_of(centre.x - reach.x, centre.x + reach.x, cols_);
  // Rows count downwards.
  const Span rows = span_of(-centre.y - reach.y, -centre.y + reach.y, rows_);
  return {rows.first, cols.first, rows.count, cols.count};
}

}  // namespace pillarfield
