#pragma once

#include <cmath>

#include "base/wide.h"
#include "contacts/estimator/contact_parameters.h"

namespace pillarfield {

/// An estimate of a normal force, N, and its variance, N².
struct NormalEstimate {
  double normal;
  double variance;

  /// Weight of another estimate beside this one, by inverse variance.
  [[nodiscard]] double weight_of(const NormalEstimate& other) const {
    return variance / (variance + other.variance);
  }
  [[nodiscard]] NormalEstimate fused(const NormalEstimate& other) const {
    const double weight = weight_of(other);
    return {normal + weight * (other.normal - normal), (1 - weight) * variance};
  }
};

/// The normal force of a pillar whose square, N², the regression predicts as `square` > 0 with a
/// `variance`, N⁴ (C6), limited to the end `high` of its segment, N, plus noise.
[[nodiscard]] PF_WIDE_INLINE NormalEstimate predicted_normal(double square, double variance,
                                                             double high, double noise_n,
                                                             const ContactParameters& parameters) {
  const double most = high + noise_n;
  const double root = std::sqrt(square);
  const double normal = root < most ? root : most;
  const double factor = parameters.regression_factor;
  const double own = parameters.prediction_deviation * normal;
  return {normal, factor * factor * variance / (4 * square) + noise_n * noise_n + own * own};
}

}  // namespace pillarfield
