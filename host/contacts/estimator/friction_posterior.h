#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "contacts/estimator/contact_parameters.h"
#include "pillarfield/friction.h"

namespace pillarfield {

/// Grid of friction coefficients: equal steps of the logarithm, from 0.1 to 10.
struct FrictionGrid {
  static constexpr std::size_t kPoints = 160;
  static constexpr double kLeast = 0.1;
  static constexpr double kMost = 100;    ///< larger ratios are those of the last point
  static constexpr double kStep = 0.029;  ///< of the logarithm

  /// The point nearest to a ratio, clamped to the ends; the first for NaN.
  [[nodiscard]] static std::size_t nearest(double ratio);
  [[nodiscard]] static double at(double point);
};

/// Standard deviation of the logarithm of a given friction.
inline constexpr double kGivenFrictionSpread = 0.03;

/// A value per grid point.
using FrictionCurve = std::array<double, FrictionGrid::kPoints>;

/// Posterior over the friction coefficient of one contact: a probability per grid point
/// (docs/derivations/contact.md, C2).
class FrictionPosterior {
 public:
  FrictionPosterior() = default;
  /// The prior: log-normal, cut at the bound (C1).
  explicit FrictionPosterior(const FrictionKnowledge& knowledge);

  /// The posterior one frame later: the prior replaces the fraction `forgetting` (C2).
  [[nodiscard]] FrictionPosterior carried(const FrictionPosterior& prior, double forgetting) const;

  /// Applies Bayes' rule with the logarithm of a likelihood.
  void update(const FrictionCurve& log_likelihood);

  /// The frictions below which these fractions of the probability lie, (0, 1) and rising.
  void quantiles(std::span<const double> fractions, std::span<double> frictions) const;
  [[nodiscard]] double quantile(double fraction) const;

  struct Summary {
    double median;
    /// Standard deviation of the logarithm: half the distance between the 15.9 % and 84.1 %
    /// quantiles, so that tails do not count.
    double spread;
  };
  [[nodiscard]] Summary summary() const;

 private:
  void normalise();

  FrictionCurve probability_{};
};

}  // namespace pillarfield
