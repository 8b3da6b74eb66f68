#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "contacts/estimator/contact_parameters.h"
#include "pillarfield/friction.h"

namespace pillarfield {

/// The grid on which friction coefficients are weighed: equal steps of their logarithm.
struct FrictionGrid {
  static constexpr std::size_t kPoints = 160;
  static constexpr double kLeast = 0.1;
  static constexpr double kStep = 0.029;  ///< of the logarithm; the last point is 10

  /// The nearest point to a ratio; the first or the last beyond the ends, the first for NaN.
  [[nodiscard]] static std::size_t nearest(double ratio);
  [[nodiscard]] static double at(double point);
};

/// What is left open of a friction that was given: its logarithm's standard deviation.
inline constexpr double kGivenFrictionSpread = 0.03;

/// A number for each point of the grid.
using FrictionCurve = std::array<double, FrictionGrid::kPoints>;

/// What is believed of the friction coefficient of one contact: a probability for each point of the
/// grid (docs/derivations/contact.md, C2).
class FrictionBelief {
 public:
  FrictionBelief() = default;
  /// What is known before any reading: log-normal, cut at the bound.
  explicit FrictionBelief(const FrictionKnowledge& knowledge);

  /// This belief a frame later: a part `forgetting` of it gives way to the prior.
  [[nodiscard]] FrictionBelief carried(const FrictionBelief& prior, double forgetting) const;

  /// Bayes' rule with the logarithm of a likelihood.
  void update(const FrictionCurve& log_likelihood);

  /// The friction below which this share of the probability lies, (0, 1).
  [[nodiscard]] double quantile(double share) const;
  /// Standard deviation of its logarithm, nearly the relative one of the friction: half of what
  /// lies between the quantiles at which a normal distribution has it, whatever the tails.
  [[nodiscard]] double spread() const;

 private:
  void normalise();

  FrictionCurve probability_{};
};

}  // namespace pillarfield
