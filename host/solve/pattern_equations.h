#pragma once

#include <array>
#include <cstddef>

namespace pillarfield {

/// Factors of three patterns, or a sample of each.
using PatternTriple = std::array<double, 3>;

/// Normal equations of least squares for the factors of three patterns.
class PatternEquations {
 public:
  void add(const PatternTriple& pattern, double difference, double weight = 1) {
    for (std::size_t row = 0; row < 3; ++row) {
      const double weighted = weight * pattern[row];
      right_[row] += weighted * difference;
      for (std::size_t col = 0; col < 3; ++col) normal_[row][col] += weighted * pattern[col];
    }
  }

  /// By Cramer's rule; a small ridge, in parts of the trace, leaves out what the samples do not
  /// determine.
  [[nodiscard]] PatternTriple solution(double ridge = 1e-9) const {
    const double trace = normal_[0][0] + normal_[1][1] + normal_[2][2];
    if (!(trace > 0)) return {};
    Matrix normal = normal_;
    for (std::size_t i = 0; i < 3; ++i) normal[i][i] += ridge * trace;
    const double all = determinant(normal);
    PatternTriple solution{};
    for (std::size_t column = 0; column < 3; ++column) {
      Matrix replaced = normal;
      for (std::size_t row = 0; row < 3; ++row) replaced[row][column] = right_[row];
      solution[column] = determinant(replaced) / all;
    }
    return solution;
  }

 private:
  using Matrix = std::array<PatternTriple, 3>;

  static double determinant(const Matrix& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  }

  Matrix normal_{};
  PatternTriple right_{};
};

}  // namespace pillarfield
