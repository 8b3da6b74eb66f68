#pragma once

#include <cstddef>
#include <vector>

namespace pillarfield {

/// A symmetric, positive definite matrix whose entries lie within `reach` of the diagonal, and its
/// Cholesky factor. Takes size · reach² operations.
class BandedFactor {
 public:
  BandedFactor(std::size_t size, std::size_t reach);

  /// Adds to the entries (i, j) and (j, i), j <= i <= j + reach; before factorise().
  void add(std::size_t i, std::size_t j, double value) { band_[j * width_ + i - j] += value; }

  /// Replaces the matrix by its factor L, of L Lᵀ.
  void factorise();

  /// The solution for a right side.
  [[nodiscard]] std::vector<double> solve(std::vector<double> right) const;

  /// Normal variates of the inverse matrix as covariance, from independent ones.
  [[nodiscard]] std::vector<double> spread(std::vector<double> independent) const;

 private:
  std::size_t size_;
  std::size_t width_;         ///< reach + 1
  std::vector<double> band_;  ///< [column, distance below the diagonal]
};

}  // namespace pillarfield
