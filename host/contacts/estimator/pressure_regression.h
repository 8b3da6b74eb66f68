#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace pillarfield {

/// Robust regression of the squared normal force of a contact's pillars on a polynomial of degree 2
/// in the place, exact under Hertz's pressure (docs/derivations/contact.md, C6).
class PressureRegression {
 public:
  struct Sample {
    double x = 0;  ///< place, magnitude about 1
    double y = 0;
    double square = 0;    ///< N²
    double weight = 0;    ///< 0 or more
    double residual = 0;  ///< of the last fit, N²
  };
  static constexpr std::size_t kBatch = 32;  ///< places predicted at a time
  using Values = std::array<double, kBatch>;
  struct Predictions {
    Values square{};    ///< N², may be negative
    Values variance{};  ///< N⁴
  };

  /// Fits the polynomial; unset for fewer than 12 samples or samples on a conic or line.
  static std::optional<PressureRegression> fit(std::vector<Sample>& samples);

  void predict(const Values& x, const Values& y, Predictions& predictions) const;

 private:
  static constexpr std::size_t kTerms = 6;
  using Terms = std::array<double, kTerms>;
  using Matrix = std::array<Terms, kTerms>;

  static Terms terms_of(double x, double y) { return {1, x, y, x * x, x * y, y * y}; }
  static bool factorise(Matrix& matrix);
  static void forward(const Matrix& factor, Terms& values);
  static void backward(const Matrix& factor, Terms& values);
  static Matrix inverse_of(const Matrix& factor);

  Terms coefficients_{};
  Matrix inverse_{};        ///< of Cholesky's factor, lower triangle
  double mean_square_ = 0;  ///< mean square of the residuals
};

}  // namespace pillarfield
