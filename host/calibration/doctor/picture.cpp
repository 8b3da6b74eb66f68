#include <algorithm>
#include <array>
#include <cmath>

#include "base/quantile.h"
#include "pillarfield/doctor.h"

namespace pillarfield {
namespace {

using MarkColour = std::array<std::uint8_t, 3>;

constexpr std::uint32_t kLargestSide = 1200;  // pixels, as far as a sensel has one at least
constexpr std::uint32_t kLargestSquare = 32;
constexpr std::uint32_t kLeastFramed = 5;  ///< pixels of a square with a frame

MarkColour colour_of(ArrayFault fault) {
  switch (fault) {
    case ArrayFault::absent:
      return {70, 110, 255};
    case ArrayFault::stuck:
    case ArrayFault::noisy:
      return {255, 150, 0};
    case ArrayFault::saturated:
      return {255, 0, 255};
    case ArrayFault::dead:
    case ArrayFault::dead_row:
    case ArrayFault::dead_column:
      return {255, 40, 40};
    case ArrayFault::shorted_rows:
    case ArrayFault::shorted_columns:
      return {255, 255, 0};
    case ArrayFault::row_order:
    case ArrayFault::column_order:
    case ArrayFault::row_crosstalk:
    case ArrayFault::column_crosstalk:
    default:
      break;
  }
  return {0, 255, 255};
}

bool is_of_rows(ArrayFault fault) {
  return fault == ArrayFault::dead_row || fault == ArrayFault::shorted_rows ||
         fault == ArrayFault::row_order;
}

/// A picture of squares, one a sensel, with a margin of one square.
class SenselSquares {
 public:
  explicit SenselSquares(const Diagnosis& diagnosis)
      : rows_(diagnosis.rows),
        cols_(diagnosis.cols),
        side_(std::clamp(kLargestSide / std::max(rows_, cols_), 1U, kLargestSquare)) {
    picture_.width = (cols_ + 2) * side_;
    picture_.height = (rows_ + 2) * side_;
    picture_.rgb.assign(std::size_t{3} * picture_.width * picture_.height, 24);
  }

  void fill(std::uint32_t row, std::uint32_t col, const MarkColour& colour) {
    paint((row + 1) * side_, (col + 1) * side_, side_, side_, colour);
  }

  void frame(std::uint32_t row, std::uint32_t col, const MarkColour& colour) {
    if (side_ < kLeastFramed) return fill(row, col, colour);
    const std::uint32_t width = std::max(side_ / 8, 1U);
    const std::uint32_t top = (row + 1) * side_;
    const std::uint32_t left = (col + 1) * side_;
    paint(top, left, width, side_, colour);
    paint(top + side_ - width, left, width, side_, colour);
    paint(top, left, side_, width, colour);
    paint(top, left + side_ - width, side_, width, colour);
  }

  /// Marks a row or a column in the margins at both of its ends.
  void mark(bool is_row, std::uint32_t line, const MarkColour& colour) {
    const std::uint32_t at = (line + 1) * side_;
    const std::uint32_t end = ((is_row ? cols_ : rows_) + 1) * side_;
    const std::uint32_t thick = (side_ + 1) / 2;
    for (const std::uint32_t begin : {side_ - thick, end}) {
      if (is_row) paint(at, begin, side_, thick, colour);
      if (!is_row) paint(begin, at, thick, side_, colour);
    }
  }

  [[nodiscard]] RgbPicture take() { return std::move(picture_); }

 private:
  void paint(std::uint32_t top, std::uint32_t left, std::uint32_t height, std::uint32_t width,
             const MarkColour& colour) {
    for (std::uint32_t y = top; y < top + height; ++y) {
      for (std::uint32_t x = left; x < left + width; ++x) {
        std::ranges::copy(
            colour, picture_.rgb.begin() +
                        static_cast<std::ptrdiff_t>(3 * (std::size_t{y} * picture_.width + x)));
      }
    }
  }

  std::uint32_t rows_;
  std::uint32_t cols_;
  std::uint32_t side_;  ///< of a square, pixels
  RgbPicture picture_;
};

}  // namespace

RgbPicture draw(const Diagnosis& diagnosis) {
  SenselSquares squares(diagnosis);
  std::vector<float> sorted = diagnosis.picture;
  const double full = std::max(1e-30F, quantile(sorted, 0.99));
  for (std::uint32_t row = 0; row < diagnosis.rows; ++row) {
    for (std::uint32_t col = 0; col < diagnosis.cols; ++col) {
      const double signal = diagnosis.picture[std::size_t{row} * diagnosis.cols + col];
      const auto grey =
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(signal / full, 0.0, 1.0)));
      squares.fill(row, col, {grey, grey, grey});
    }
  }
  for (const ArrayFinding& finding : diagnosis.findings) {
    const MarkColour colour = colour_of(finding.fault);
    for (const auto& [row, col] : finding.sensels) squares.frame(row, col, colour);
    for (const std::uint32_t line : finding.lines) {
      squares.mark(is_of_rows(finding.fault), line, colour);
    }
  }
  return squares.take();
}

}  // namespace pillarfield
