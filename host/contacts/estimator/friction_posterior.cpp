#include "contacts/estimator/friction_posterior.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/log_exp.h"
#include "base/wide.h"

namespace pillarfield {
namespace {

/// Smallest prior probability that one frame can still raise.
constexpr double kLeastProbability = 1e-30;

/// Least sum of products of prior and likelihood that keep their precision.
constexpr double kLeastPosterior = 1e-200;

double largest_of(const FrictionCurve& curve) {
  return *std::max_element(curve.begin(), curve.end());
}

/// Multiplies probabilities by the likelihood over that of the logarithm `largest`.
PF_WIDE void weigh(const FrictionCurve& log_likelihood, double largest,
                   FrictionCurve& probability) {
  for (std::size_t i = 0; i < probability.size(); ++i) {
    probability[i] *= fast_exp(log_likelihood[i] - largest);
  }
}

}  // namespace

std::size_t FrictionGrid::nearest(double ratio) {
  if (!(ratio > kLeast)) return 0;
  const double point = fast_log(std::min(ratio, kMost) / kLeast) / kStep + 0.5;
  return static_cast<std::size_t>(std::min(point, static_cast<double>(kPoints - 1)));
}

double FrictionGrid::at(double point) { return kLeast * fast_exp(point * kStep); }

FrictionPosterior::FrictionPosterior(const FrictionKnowledge& knowledge) {
  const double centre = std::log(knowledge.given.value_or(knowledge.median));
  const double spread = knowledge.given ? kGivenFrictionSpread : knowledge.spread;
  for (std::size_t i = 0; i < probability_.size(); ++i) {
    const double friction = FrictionGrid::at(static_cast<double>(i));
    const double deviations = (std::log(friction) - centre) / spread;
    const bool allowed = !knowledge.bound || friction <= *knowledge.bound;
    probability_[i] = allowed ? std::exp(-0.5 * deviations * deviations) : 0;
  }
  // The bound's own grid point stays possible.
  if (knowledge.bound) probability_[FrictionGrid::nearest(*knowledge.bound)] += kLeastProbability;
  normalise();
}

FrictionPosterior FrictionPosterior::carried(const FrictionPosterior& prior,
                                             double forgetting) const {
  FrictionPosterior later;
  for (std::size_t i = 0; i < probability_.size(); ++i) {
    later.probability_[i] = (1 - forgetting) * probability_[i] + forgetting * prior.probability_[i];
  }
  return later;
}

void FrictionPosterior::update(const FrictionCurve& log_likelihood) {
  FrictionCurve updated = probability_;
  weigh(log_likelihood, largest_of(log_likelihood), updated);
  if (!(std::accumulate(updated.begin(), updated.end(), 0.0) > kLeastPosterior)) {
    // The likelihood is far from the prior: its largest value is that where the prior has weight.
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < probability_.size(); ++i) {
      if (probability_[i] > 0)
        largest = std::max(largest, std::log(probability_[i]) + log_likelihood[i]);
    }
    for (std::size_t i = 0; i < probability_.size(); ++i) {
      updated[i] = probability_[i] > 0
                       ? std::exp(std::log(probability_[i]) + log_likelihood[i] - largest)
                       : 0;
    }
  }
  probability_ = updated;
  normalise();
}

void FrictionPosterior::normalise() {
  const double sum = std::accumulate(probability_.begin(), probability_.end(), 0.0);
  for (double& each : probability_) each /= sum;
}

void FrictionPosterior::quantiles(std::span<const double> fractions,
                                  std::span<double> frictions) const {
  double below = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < probability_.size() && next < fractions.size(); ++i) {
    const double with = below + probability_[i];
    for (; next < fractions.size() && with >= fractions[next] && probability_[i] > 0; ++next) {
      frictions[next] = FrictionGrid::at(static_cast<double>(i) - 0.5 +
                                         (fractions[next] - below) / probability_[i]);
    }
    below = with;
  }
  for (; next < fractions.size(); ++next)
    frictions[next] = FrictionGrid::at(static_cast<double>(probability_.size() - 1));
}

double FrictionPosterior::quantile(double fraction) const {
  double friction = 0;
  quantiles({&fraction, 1}, {&friction, 1});
  return friction;
}

FrictionPosterior::Summary FrictionPosterior::summary() const {
  constexpr std::array kFractions = {0.159, 0.5, 0.841};
  std::array<double, kFractions.size()> frictions{};
  quantiles(kFractions, frictions);
  return {frictions[1], 0.5 * std::log(frictions[2] / frictions[0])};
}

}  // namespace pillarfield
