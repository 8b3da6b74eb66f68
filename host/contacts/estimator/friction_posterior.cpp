#include "contacts/estimator/friction_posterior.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pillarfield {
namespace {

/// Smallest prior probability that one frame can still raise.
constexpr double kLeastProbability = 1e-30;

}  // namespace

std::size_t FrictionGrid::nearest(double ratio) {
  if (!(ratio > kLeast)) return 0;
  const double point = std::log(ratio / kLeast) / kStep + 0.5;
  return static_cast<std::size_t>(std::min(point, static_cast<double>(kPoints - 1)));
}

double FrictionGrid::at(double point) { return kLeast * std::exp(point * kStep); }

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
  const double best = *std::max_element(log_likelihood.begin(), log_likelihood.end());
  FrictionCurve logarithm{};
  for (std::size_t i = 0; i < probability_.size(); ++i) {
    logarithm[i] = probability_[i] > 0 ? std::log(probability_[i]) + log_likelihood[i] - best
                                       : -std::numeric_limits<double>::infinity();
  }
  const double top = *std::max_element(logarithm.begin(), logarithm.end());
  for (std::size_t i = 0; i < probability_.size(); ++i) {
    probability_[i] = std::exp(logarithm[i] - top);
  }
  normalise();
}

void FrictionPosterior::normalise() {
  const double sum = std::accumulate(probability_.begin(), probability_.end(), 0.0);
  for (double& each : probability_) each /= sum;
}

double FrictionPosterior::quantile(double fraction) const {
  double below = 0;
  for (std::size_t i = 0; i < probability_.size(); ++i) {
    const double with = below + probability_[i];
    if (with >= fraction && probability_[i] > 0) {
      return FrictionGrid::at(static_cast<double>(i) - 0.5 + (fraction - below) / probability_[i]);
    }
    below = with;
  }
  return FrictionGrid::at(static_cast<double>(probability_.size() - 1));
}

double FrictionPosterior::spread() const {
  return 0.5 * std::log(quantile(0.841) / quantile(0.159));
}

}  // namespace pillarfield
