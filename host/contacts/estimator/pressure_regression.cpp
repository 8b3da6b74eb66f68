#include "contacts/estimator/pressure_regression.h"

#include <algorithm>
#include <cmath>

#include "base/wide.h"

namespace pillarfield {
namespace {

constexpr std::size_t kLeastSamples = 12;
constexpr int kRounds = 3;  ///< of reweighting
/// Residual, in standard deviations, that halves a sample's weight.
constexpr double kHalfWeight = 2;
/// Least pivot of the Cholesky factorisation as a fraction of the diagonal; below it the fit is
/// singular.
constexpr double kLeastPivot = 1e-9;

/// The polynomial at places, and their leverages as variances.
template <class Terms, class Matrix>
PF_WIDE void evaluate(const PressureRegression::Values& x, const PressureRegression::Values& y,
                      const Terms& coefficients, const Matrix& inverse,
                      PressureRegression::Predictions& found) {
  std::array<PressureRegression::Values, 6> terms{};
  terms[0].fill(1);
  for (std::size_t i = 0; i < x.size(); ++i) {
    terms[1][i] = x[i];
    terms[2][i] = y[i];
    terms[3][i] = x[i] * x[i];
    terms[4][i] = x[i] * y[i];
    terms[5][i] = y[i] * y[i];
  }
  found = {};
  for (std::size_t row = 0; row < terms.size(); ++row) {
    PressureRegression::Values sum{};
    for (std::size_t col = 0; col <= row; ++col) {
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += inverse[row][col] * terms[col][i];
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      found.square[i] += coefficients[row] * terms[row][i];
      found.variance[i] += sum[i] * sum[i];
    }
  }
}

}  // namespace

bool PressureRegression::factorise(Matrix& matrix) {
  for (std::size_t i = 0; i < kTerms; ++i) {
    const double diagonal = matrix[i][i];
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = matrix[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= matrix[i][k] * matrix[j][k];
      if (i != j) {
        matrix[i][j] = sum / matrix[j][j];
      } else {
        if (!(sum > kLeastPivot * diagonal)) return false;
        matrix[i][i] = std::sqrt(sum);
      }
    }
  }
  return true;
}

void PressureRegression::forward(const Matrix& factor, Terms& values) {
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t k = 0; k < i; ++k) values[i] -= factor[i][k] * values[k];
    values[i] /= factor[i][i];
  }
}

void PressureRegression::backward(const Matrix& factor, Terms& values) {
  for (std::size_t i = kTerms; i-- > 0;) {
    for (std::size_t k = i + 1; k < kTerms; ++k) values[i] -= factor[k][i] * values[k];
    values[i] /= factor[i][i];
  }
}

std::optional<PressureRegression> PressureRegression::fit(std::vector<Sample>& samples) {
  if (samples.size() < kLeastSamples) return std::nullopt;
  PressureRegression result;
  for (int round = 0; round < kRounds; ++round) {
    const double bend = kHalfWeight * kHalfWeight * result.mean_square_;
    const auto weight_of = [&](const Sample& sample) {
      return bend > 0 ? sample.weight * bend / (bend + sample.residual * sample.residual)
                      : sample.weight;
    };
    Matrix matrix{};
    Terms right{};
    double weights = 0;
    for (const Sample& sample : samples) {
      const Terms terms = terms_of(sample.x, sample.y);
      const double weight = weight_of(sample);
      weights += weight;
      for (std::size_t row = 0; row < kTerms; ++row) {
        const double weighted = weight * terms[row];
        for (std::size_t col = 0; col <= row; ++col) matrix[row][col] += weighted * terms[col];
        right[row] += weighted * sample.square;
      }
    }
    if (!factorise(matrix)) return std::nullopt;
    forward(matrix, right);
    backward(matrix, right);
    result.coefficients_ = right;
    double squares = 0;
    for (Sample& sample : samples) {
      const double weight = weight_of(sample);
      const Terms terms = terms_of(sample.x, sample.y);
      double fitted = 0;
      for (std::size_t k = 0; k < kTerms; ++k) fitted += right[k] * terms[k];
      sample.residual = sample.square - fitted;
      squares += weight * sample.residual * sample.residual;
    }
    result.mean_square_ = squares / std::max(weights - static_cast<double>(kTerms), 2.0);
    if (round + 1 == kRounds) result.inverse_ = inverse_of(matrix);
  }
  return result;
}

PressureRegression::Matrix PressureRegression::inverse_of(const Matrix& factor) {
  Matrix inverse{};
  for (std::size_t col = 0; col < kTerms; ++col) {
    Terms unit{};
    unit[col] = 1;
    forward(factor, unit);
    for (std::size_t row = col; row < kTerms; ++row) inverse[row][col] = unit[row];
  }
  return inverse;
}

void PressureRegression::predict(const Values& x, const Values& y, Predictions& predictions) const {
  evaluate(x, y, coefficients_, inverse_, predictions);
  for (double& variance : predictions.variance) variance = mean_square_ * (1 + variance);
}

}  // namespace pillarfield
