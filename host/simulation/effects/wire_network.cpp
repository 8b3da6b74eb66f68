#include "simulation/effects/wire_network.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pillarfield {
namespace {

/// A dense matrix, row by row.
struct Matrix {
  Matrix(std::size_t height, std::size_t width)
      : rows(height), cols(width), values(height * width) {}

  [[nodiscard]] std::span<double> row(std::size_t index) {
    return std::span(values).subspan(index * cols, cols);
  }
  [[nodiscard]] std::span<const double> row(std::size_t index) const {
    return std::span(values).subspan(index * cols, cols);
  }

  std::size_t rows;
  std::size_t cols;
  std::vector<double> values;
};

/// to += factor · from
void add_multiple(std::span<const double> from, double factor, std::span<double> to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
}

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result(a.rows, b.cols);
  for (std::size_t i = 0; i < a.rows; ++i) {
    for (std::size_t k = 0; k < a.cols; ++k) {
      if (a.row(i)[k] != 0) add_multiple(b.row(k), a.row(i)[k], result.row(i));
    }
  }
  return result;
}

/// Inverse of a positive definite matrix by Gauss and Jordan, in place and without pivots.
void invert(Matrix& matrix) {
  std::vector<double> pivot_row(matrix.cols);
  for (std::size_t pivot = 0; pivot < matrix.rows; ++pivot) {
    const std::span<double> row = matrix.row(pivot);
    const double scale = 1 / row[pivot];
    row[pivot] = 1;
    for (double& value : row) value *= scale;
    std::ranges::copy(row, pivot_row.begin());
    for (std::size_t other = 0; other < matrix.rows; ++other) {
      if (other == pivot) continue;
      const std::span<double> target = matrix.row(other);
      const double factor = target[pivot];
      if (factor == 0) continue;
      target[pivot] = 0;
      add_multiple(pivot_row, -factor, target);
    }
  }
}

std::vector<double> column_sums(const Matrix& matrix) {
  std::vector<double> sums(matrix.cols);
  for (std::size_t row = 0; row < matrix.rows; ++row) add_multiple(matrix.row(row), 1, sums);
  return sums;
}

/// L of the rows, the columns being eliminated.
Matrix row_admittance(const Matrix& conductance, double column_per_count) {
  const std::vector<double> sums = column_sums(conductance);
  Matrix admittance(conductance.rows, conductance.rows);
  std::vector<double> weighted(conductance.cols);
  for (std::size_t row = 0; row < conductance.rows; ++row) {
    const std::span<const double> g = conductance.row(row);
    double total = 0;
    for (std::size_t col = 0; col < g.size(); ++col) {
      total += g[col];
      weighted[col] = g[col] * column_per_count / (1 + column_per_count * sums[col]);
    }
    for (std::size_t other = 0; other < conductance.rows; ++other) {
      admittance.row(row)[other] = -dot(weighted, conductance.row(other));
    }
    admittance.row(row)[row] += total;
  }
  return admittance;
}

/// Readings of the columns of a tile with each row driven in turn.
Matrix scan(const WireCrosstalk& wires, const Matrix& conductance) {
  const Matrix admittance = row_admittance(conductance, wires.column_per_count);
  Matrix potential = admittance;
  for (double& value : potential.values) value *= wires.idle_per_count;
  for (std::size_t row = 0; row < potential.rows; ++row) potential.row(row)[row] += 1;
  invert(potential);
  Matrix readings = product(potential, conductance);
  const std::vector<double> sums = column_sums(conductance);
  for (std::size_t row = 0; row < readings.rows; ++row) {
    const double current = dot(admittance.row(row), potential.row(row));
    const double driven = 1 - (wires.idle_per_count - wires.row_per_count) * current;
    for (std::size_t col = 0; col < readings.cols; ++col) {
      readings.row(row)[col] /= driven * (1 + wires.column_per_count * sums[col]);
    }
  }
  return readings;
}

}  // namespace

void read_through_wires(const WireCrosstalk& wires, std::uint32_t rows, std::uint32_t cols,
                        std::span<double> readings) {
  for (std::size_t top = 0; top < rows; top += wires.tile_rows) {
    for (std::size_t left = 0; left < cols; left += wires.tile_cols) {
      Matrix tile(std::min<std::size_t>(wires.tile_rows, rows - top),
                  std::min<std::size_t>(wires.tile_cols, cols - left));
      const auto row_of_tile = [&](std::size_t row) {
        return readings.subspan((top + row) * cols + left, tile.cols);
      };
      for (std::size_t row = 0; row < tile.rows; ++row) {
        std::ranges::transform(row_of_tile(row), tile.row(row).begin(),
                               [](double reading) { return std::max(0.0, reading); });
      }
      if (std::ranges::all_of(tile.values, [](double value) { return value == 0; })) continue;
      const Matrix scanned = scan(wires, tile);
      for (std::size_t row = 0; row < tile.rows; ++row) {
        std::ranges::copy(scanned.row(row), row_of_tile(row).begin());
      }
    }
  }
}

}  // namespace pillarfield
