#include "calibration/banded_factor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pillarfield {

BandedFactor::BandedFactor(std::size_t size, std::size_t reach)
    : size_(size), width_(std::min(size, reach + 1)), band_(size * width_, 0.0) {}

void BandedFactor::factorise() {
  for (std::size_t j = 0; j < size_; ++j) {
    double* const column = &band_[j * width_];
    const std::size_t below = std::min(width_, size_ - j);
    const double root = std::sqrt(column[0]);
    for (std::size_t i = 0; i < below; ++i) column[i] /= root;
    for (std::size_t k = 1; k < below; ++k) {
      const double factor = column[k];
      if (factor == 0) continue;
      double* const later = &band_[(j + k) * width_];
      for (std::size_t i = k; i < below; ++i) later[i - k] -= factor * column[i];
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
