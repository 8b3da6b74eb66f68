#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "solve/sensor_corrections.h"

namespace pillarfield {
namespace {

constexpr std::size_t kCurveSamples = 400;

using CurveColumn = std::vector<double>;  // one value a sample

/// x of a sample, in (0, 1]: even in its cube root, so that small readings, whose loads decide
/// about a touch, have weight.
double sample_at(std::size_t i) {
  const double root = static_cast<double>(i + 1) / static_cast<double>(kCurveSamples);
  return root * root * root;
}

double dot(const CurveColumn& a, const CurveColumn& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void subtract(CurveColumn& from, double factor, const CurveColumn& column) {
  for (std::size_t i = 0; i < from.size(); ++i) from[i] -= factor * column[i];
}

/// Least squares of `target` in x, x·t, x·t², ..., t being x or, with `root`, its root, by Gram and
/// Schmidt, twice for accuracy; returns the coefficients.
std::vector<double> powers_fit(const CurveColumn& target, std::size_t terms, bool root) {
  std::vector<CurveColumn> basis;              // orthonormal
  std::vector<std::vector<double>> in_powers;  // its coefficients in the powers
  std::vector<double> result(terms, 0);
  CurveColumn rest = target;
  for (std::size_t term = 0; term < terms; ++term) {
    CurveColumn column(kCurveSamples);
    for (std::size_t i = 0; i < kCurveSamples; ++i) {
      const double exponent = 1 + (root ? 0.5 : 1.0) * static_cast<double>(term);
      column[i] = std::pow(sample_at(i), exponent);
    }
    std::vector<double> powers(terms, 0);
    powers[term] = 1;
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t other = 0; other < term; ++other) {
        const double part = dot(column, basis[other]);
        subtract(column, part, basis[other]);
        for (std::size_t k = 0; k < terms; ++k) powers[k] -= part * in_powers[other][k];
      }
    }
    const double length = std::sqrt(dot(column, column));
    for (double& value : column) value /= length;
    for (double& value : powers) value /= length;
    const double part = dot(rest, column);
    subtract(rest, part, column);
    for (std::size_t k = 0; k < terms; ++k) result[k] += part * powers[k];
    basis.push_back(std::move(column));
    in_powers.push_back(std::move(powers));
  }
  return result;
}

bool increases(const single_precision::CurvePolynomial& curve, double reach) {
  float before = 0;
  for (std::size_t i = 0; i < kCurveSamples; ++i) {
    const auto reading = static_cast<float>(reach * sample_at(i));
    const float load = single_precision::curve_load(reading, curve);
    if (!(load > before)) return false;
    before = load;
  }
  return true;
}

}  // namespace

namespace {

/// The fit in powers of x or of its root, with the most terms that increases everywhere.
CurveFit curve_fit(const CurveColumn& target, double reach, bool root) {
  CurveFit fit;
  for (std::size_t terms = PF_CURVE_TERMS; terms > 0; --terms) {
    const std::vector<double> powers = powers_fit(target, terms, root);
    fit.polynomial = {};
    fit.polynomial.per_count = static_cast<float>(1 / reach);
    fit.polynomial.root = root ? 1 : 0;
    for (std::size_t k = 0; k < terms; ++k) {
      fit.polynomial.terms[k] = static_cast<float>(powers[k] / reach);
    }
    if (increases(fit.polynomial, reach)) break;
  }
  double squares = 0;
  for (std::size_t i = 0; i < kCurveSamples; ++i) {
    const auto reading = static_cast<float>(reach * sample_at(i));
    const double off = single_precision::curve_load(reading, fit.polynomial) - target[i];
    squares += off * off;
  }
  fit.rms_counts = std::sqrt(squares / static_cast<double>(kCurveSamples));
  return fit;
}

}  // namespace

CurveFit curve_polynomial(const ResponseCurve& curve) {
  if (curve.empty()) return {};
  const double reach = kCurveReach * curve.readings.back();
  CurveColumn target(kCurveSamples);
  for (std::size_t i = 0; i < kCurveSamples; ++i) target[i] = load_at(curve, reach * sample_at(i));
  const CurveFit straight = curve_fit(target, reach, false);
  const CurveFit rooted = curve_fit(target, reach, true);
  return rooted.rms_counts < straight.rms_counts ? rooted : straight;
}

double reading_at(const single_precision::CurvePolynomial& curve, double load) {
  double low = 0;
  double high = 1 / double{curve.per_count};
  for (int step = 0; step < 60; ++step) {
    const double middle = (low + high) / 2;
    const float at = single_precision::curve_load(static_cast<float>(middle), curve);
    (at < load ? low : high) = middle;
  }
  return low;
}

}  // namespace pillarfield
