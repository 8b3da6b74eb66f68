#include "solve/wire_factors.h"

#include <algorithm>
#include <cmath>

#include "skin/quads.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

std::size_t tiles_along(std::size_t sensels, std::size_t tile) {
  return (sensels + tile - 1) / tile;
}

/// A reading less its offset, if there are some, for the sums; a missing sensel counts as zero.
float summed_reading(const SolverPlan& plan, const FrameView& frame, std::span<const float> offsets,
                     std::size_t row, std::size_t col) {
  if (row >= frame.rows || col >= frame.cols) return 0;
  const auto& mask = plan.calibration.mask;
  const std::size_t i = row * frame.cols + col;
  if (!mask.empty() && mask[i] != 1) return 0;
  const auto reading = raw_reading(frame, row, col);
  if (!(std::abs(reading) <= static_cast<float>(kMaxCounts))) return 0;
  return offsets.empty() ? reading : reading - offsets[i];
}

}  // namespace

WireFactors::WireFactors(const SolverPlan& plan, const FrameView& frame,
                         std::span<const float> tares) {
  if (!plan.calibration.effects.wires) return;
  const auto offsets =
      has_offset_tares(plan.calibration.effects) ? tares : std::span<const float>();
  wires_ = *plan.calibration.effects.wires;
  rows_ = 2 * std::size_t{quad_rows(plan.skin)};
  cols_ = 2 * std::size_t{quad_cols(plan.skin)};
  row_factors_.assign(rows_ * tiles_along(cols_, wires_.tile_cols), {1, 0});
  column_gains_.resize(cols_ * tiles_along(rows_, wires_.tile_rows));
  for (std::size_t row = 0; row < rows_; row += wires_.tile_rows) {
    for (std::size_t col = 0; col < cols_; col += wires_.tile_cols)
      find_tile(plan, frame, offsets, row, col);
  }
}

single_precision::Wires WireFactors::at(std::size_t row, std::size_t col) const {
  if (row >= rows_ || col >= cols_) return {};
  const auto& [gain, driven] = row_factors_[col / wires_.tile_cols * rows_ + row];
  return {gain, driven * gain, column_gains_[row / wires_.tile_rows * cols_ + col]};
}

void WireFactors::find_tile(const SolverPlan& plan, const FrameView& frame,
                            std::span<const float> offsets, std::size_t row, std::size_t col) {
  const single_precision::WireModel model = {static_cast<float>(wires_.row_per_count),
                                             static_cast<float>(wires_.column_per_count),
                                             static_cast<float>(wires_.idle_per_count)};
  const std::size_t rows = std::min<std::size_t>(wires_.tile_rows, rows_ - row);
  const std::size_t cols = std::min<std::size_t>(wires_.tile_cols, cols_ - col);
  const std::size_t padded = tiles_along(wires_.tile_cols, PF_WIRE_PARTS) * PF_WIRE_PARTS;
  std::vector<float> readings(padded);
  std::vector<float> columns(padded, 1);
  std::vector<float> losses(padded);
  const auto count = static_cast<int>(padded);
  for (int sweep = 0; sweep < PF_WIRE_SWEEPS; ++sweep) {
    for (std::size_t r = row; r < row + rows; ++r) {
      for (std::size_t c = 0; c < cols; ++c) {
        readings[c] = summed_reading(plan, frame, offsets, r, col + c);
      }
      auto& factors = row_factors_[col / wires_.tile_cols * rows_ + r];
      const auto [load, square] =
          single_precision::sums_of_row(readings.data(), columns.data(), count);
      factors = single_precision::wires_of_rows(load, square, factors, model);
      single_precision::add_row(readings.data(), losses.data(), count, factors.row, factors.driven,
                                model);
    }
    single_precision::find_columns(losses.data(), columns.data(), count);
  }
  const std::size_t first = row / wires_.tile_rows * cols_ + col;
  std::copy_n(columns.begin(), cols, column_gains_.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace pillarfield
