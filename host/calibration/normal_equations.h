#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace pillarfield {

/// Least squares of a few unknowns from many equations row · x = value.
class NormalEquations {
 public:
  explicit NormalEquations(std::size_t unknowns)
      : unknowns_(unknowns), matrix_(unknowns * unknowns), right_(unknowns) {}

  void add(std::span<const double> row, double value);

  [[nodiscard]] std::size_t unknowns() const { return unknowns_; }
  [[nodiscard]] double equations() const { return equations_; }

  /// Inverse of the matrix [unknowns, unknowns] of the unknowns in `active`; zero elsewhere. Unset
  /// if the equations do not determine them.
  [[nodiscard]] std::optional<std::vector<double>> inverse(const std::vector<bool>& active) const;

  /// The unknowns in `active`, the others being zero.
  [[nodiscard]] std::optional<std::vector<double>> solve(const std::vector<bool>& active) const;

  /// The least squares under x >= 0, the unknowns outside `allowed` being zero (Lawson and Hanson
  /// 1974).
  [[nodiscard]] std::vector<double> solve_non_negative(const std::vector<bool>& allowed) const;

  /// Sum of squared residuals at `x`.
  [[nodiscard]] double squares_at(const std::vector<double>& x) const;

 private:
  [[nodiscard]] std::optional<std::size_t> steepest_zero(const std::vector<double>& x,
                                                         const std::vector<bool>& active,
                                                         const std::vector<bool>& allowed,
                                                         double least) const;

  std::size_t unknowns_;
  std::vector<double> matrix_;
  std::vector<double> right_;
  double values_squared_ = 0;
  double equations_ = 0;
};

}  // namespace pillarfield
