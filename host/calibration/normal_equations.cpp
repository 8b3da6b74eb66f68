#include "calibration/normal_equations.h"

#include <algorithm>
#include <cmath>

namespace pillarfield {
namespace {

/// Moves `x` towards `next` until the first unknown reaches zero, which leaves `active`.
void step_to_zero(const std::vector<double>& next, std::vector<double>& x,
                  std::vector<bool>& active) {
  double part = 1;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (next[i] < 0) part = std::min(part, x[i] / (x[i] - next[i]));
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] += part * (next[i] - x[i]);
    if (active[i] && x[i] <= 1e-15 && next[i] < 0) {
      x[i] = 0;
      active[i] = false;
    }
  }
}

}  // namespace

void NormalEquations::add(std::span<const double> row, double value) {
  for (std::size_t i = 0; i < unknowns_; ++i) {
    for (std::size_t j = 0; j < unknowns_; ++j) matrix_[i * unknowns_ + j] += row[i] * row[j];
    right_[i] += row[i] * value;
  }
  values_squared_ += value * value;
  ++equations_;
}

std::optional<std::vector<double>> NormalEquations::inverse(const std::vector<bool>& active) const {
  // Gauss–Jordan without pivoting: the matrix is symmetric and not negative.
  const std::size_t n = unknowns_;
  constexpr double kSingular = 1e-12;
  std::vector<double> left = matrix_;
  std::vector<double> result(n * n);
  for (std::size_t i = 0; i < n; ++i) result[i * n + i] = active[i] ? 1 : 0;
  for (std::size_t p = 0; p < n; ++p) {
    if (!active[p]) continue;
    const double pivot = left[p * n + p];
    if (!(pivot > kSingular * matrix_[p * n + p])) return std::nullopt;
    for (std::size_t j = 0; j < n; ++j) {
      left[p * n + j] /= pivot;
      result[p * n + j] /= pivot;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double factor = left[i * n + p];
      if (i == p || !active[i] || factor == 0) continue;
      for (std::size_t j = 0; j < n; ++j) {
        left[i * n + j] -= factor * left[p * n + j];
        result[i * n + j] -= factor * result[p * n + j];
      }
    }
  }
  return result;
}

std::optional<std::vector<double>> NormalEquations::solve(const std::vector<bool>& active) const {
  const auto inverted = inverse(active);
  if (!inverted) return std::nullopt;
  std::vector<double> x(unknowns_);
  for (std::size_t i = 0; i < unknowns_; ++i) {
    for (std::size_t j = 0; j < unknowns_; ++j) x[i] += (*inverted)[i * unknowns_ + j] * right_[j];
  }
  return x;
}

/// The unknown at zero whose rise lowers the squares most, by more than `least` per unit.
std::optional<std::size_t> NormalEquations::steepest_zero(const std::vector<double>& x,
                                                          const std::vector<bool>& active,
                                                          const std::vector<bool>& allowed,
                                                          double least) const {
  std::optional<std::size_t> steepest;
  for (std::size_t i = 0; i < unknowns_; ++i) {
    if (active[i] || !allowed[i]) continue;
    double gradient = right_[i];
    for (std::size_t j = 0; j < unknowns_; ++j) gradient -= matrix_[i * unknowns_ + j] * x[j];
    if (!(gradient > least)) continue;
    least = gradient;
    steepest = i;
  }
  return steepest;
}

std::vector<double> NormalEquations::solve_non_negative(const std::vector<bool>& allowed) const {
  std::vector<double> x(unknowns_);
  std::vector<bool> active(unknowns_);
  double scale = 0;
  for (const double value : right_) scale = std::max(scale, std::abs(value));
  for (std::size_t step = 0; step < 3 * unknowns_ + 3; ++step) {
    const auto steepest = steepest_zero(x, active, allowed, 1e-12 * scale);
    if (!steepest) return x;
    active[*steepest] = true;
    auto next = solve(active);
    if (!next) {
      active[*steepest] = false;
      return x;
    }
    // Back to the boundary until no unknown is negative.
    while (next && *std::ranges::min_element(*next) < 0) {
      step_to_zero(*next, x, active);
      next = solve(active);
    }
    if (!next) return x;
    x = *next;
  }
  return x;
}

double NormalEquations::squares_at(const std::vector<double>& x) const {
  double squares = values_squared_;
  for (std::size_t i = 0; i < unknowns_; ++i) {
    squares -= 2 * x[i] * right_[i];
    for (std::size_t j = 0; j < unknowns_; ++j) squares += x[i] * matrix_[i * unknowns_ + j] * x[j];
  }
  return std::max(0.0, squares);
}

}  // namespace pillarfield
