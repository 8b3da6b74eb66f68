#pragma once

namespace pillarfield {

/// An estimate of a normal force, N, and its variance, N².
struct NormalEstimate {
  double normal;
  double variance;

  /// Weight of another estimate beside this one, by inverse variance.
  [[nodiscard]] double weight_of(const NormalEstimate& other) const {
    return variance / (variance + other.variance);
  }
};

}  // namespace pillarfield
