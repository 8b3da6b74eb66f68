#include "calibration/banded_factor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pillarfield {
namespace {

constexpr double kNothing = 1e-30;

}  // namespace

BandedFactor::BandedFactor(std::size_t size, std::size_t reach)
    : size_(size), width_(std::min(size, reach + 1)), band_(size * width_, 0.0) {}

/// Column by column, each less its products with the four columns before it at a time, so that it
/// is read and written once for all four.
void BandedFactor::factorise() {
  constexpr std::size_t kColumns = 4;
  for (std::size_t c = 0; c < size_; ++c) {
    double* const column = &band_[c * width_];
    const std::size_t below = std::min(width_, size_ - c);
    const auto subtract = [&](std::size_t j, std::size_t first) {
      const double* const from = &band_[j * width_ + c - j];
      const std::size_t end = std::min(below, width_ - (c - j));
      for (std::size_t i = first; i < end; ++i) column[i] -= from[0] * from[i];
    };
    std::size_t j = c - std::min(c, width_ - 1);
    for (; j + kColumns <= c; j += kColumns) {
      const double* const a = &band_[j * width_ + c - j];
      const double* const b = a + width_ - 1;
      const double* const d = b + width_ - 1;
      const double* const e = d + width_ - 1;
      // The first of the four ends before the others.
      const std::size_t end = std::min(below, width_ - (c - j));
      for (std::size_t i = 0; i < end; ++i) {
        column[i] -= a[0] * a[i] + b[0] * b[i] + d[0] * d[i] + e[0] * e[i];
      }
      for (std::size_t k = 1; k < kColumns; ++k) subtract(j + k, end);
    }
    for (; j < c; ++j) subtract(j, 0);
    const double root = std::sqrt(column[0]);
    for (std::size_t i = 0; i < below; ++i) {
      column[i] /= root;
      // Entries of distant unknowns decay to numbers whose products are slow.
      if (std::abs(column[i]) < kNothing * root) column[i] = 0;
    }
  }
}

std::vector<double> BandedFactor::spread(std::vector<double> independent) const {
  for (std::size_t j = size_; j-- > 0;) {
    const double* const column = &band_[j * width_];
    const std::size_t below = std::min(width_, size_ - j);
    double rest = independent[j];
    for (std::size_t i = 1; i < below; ++i) rest -= column[i] * independent[j + i];
    independent[j] = rest / column[0];
  }
  return independent;
}

std::vector<double> BandedFactor::solve(std::vector<double> right) const {
  for (std::size_t j = 0; j < size_; ++j) {
    const double* const column = &band_[j * width_];
    const std::size_t below = std::min(width_, size_ - j);
    right[j] /= column[0];
    for (std::size_t i = 1; i < below; ++i) right[j + i] -= column[i] * right[j];
  }
  return spread(std::move(right));
}

}  // namespace pillarfield
