#include "contacts/estimator/friction_likelihood.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/wide.h"

namespace pillarfield {
namespace {

constexpr std::size_t kPoints = FrictionGrid::kPoints;

/// Range of ratios over which an outlier's density is uniform.
constexpr double kOutlierRange = 6;

using Factors = std::array<double, kPoints>;
using Powers = std::array<float, kPoints>;

double normal_cumulative(double deviations) {
  return 0.5 * std::erfc(-deviations / std::numbers::sqrt2);
}

constexpr Factors kOnes = [] {
  Factors ones{};
  ones.fill(1);
  return ones;
}();

/// Adds the logarithm of a product of at most FrictionLikelihood::kMostPillars factors. Above 1e-4
/// each, together they may be too small for a double, where no posterior has weight.
void add_logarithm(const Factors& product, double weight, FrictionCurve& log_likelihood) {
  for (std::size_t i = 0; i < kPoints; ++i) {
    log_likelihood[i] += weight * std::log(std::max(product[i], 1e-300));
  }
}

/// Terms of one pillar's likelihood of slipping at a friction or sticking below it (C3).
struct SlipOrStick {
  const float* density;
  const float* cumulative;
  const float* below_ceiling;
  float slip;
  float stick;
  float least_factor;
  float outlier;
};

PF_WIDE void multiply(Factors& estimate, Factors& cautious, const SlipOrStick& pillar,
                      const Powers& stick_factor) {
  for (std::size_t i = 0; i < kPoints; ++i) {
    const float factor =
        stick_factor[i] > pillar.least_factor ? stick_factor[i] : pillar.least_factor;
    const float slips = pillar.slip * pillar.density[i] * pillar.below_ceiling[i] + pillar.outlier;
    const float sticks = pillar.stick * pillar.cumulative[i];
    estimate[i] *= static_cast<double>(slips + factor * sticks);
    cautious[i] *= static_cast<double>(slips + sticks);
  }
}

PF_WIDE void multiply(Factors& product, const float* cumulative, float outliers) {
  for (std::size_t i = 0; i < kPoints; ++i) {
    product[i] *= static_cast<double>(cumulative[i] * (1 - outliers) + outliers);
  }
}

double weight_of(std::size_t pillars, double effective) {
  return std::min(1.0, effective / static_cast<double>(pillars));
}

}  // namespace

FrictionLikelihood::FrictionLikelihood(const ContactParameters& parameters)
    : parameters_(parameters) {
  for (std::size_t k = 0; k < kWidths; ++k) {
    Width& width = widths_[k];
    width.deviation = parameters.ratio_deviation * std::pow(2.0, 0.5 * static_cast<double>(k));
    const double scale = 1 / (width.deviation * std::sqrt(2 * std::numbers::pi));
    for (std::size_t i = 0; i < width.density.size(); ++i) {
      const double points = static_cast<double>(i) - static_cast<double>(kPoints);
      const double deviations = points * FrictionGrid::kStep / width.deviation;
      width.density[i] = static_cast<float>(scale * std::exp(-0.5 * deviations * deviations));
      width.cumulative[i] = static_cast<float>(normal_cumulative(deviations));
    }
  }
  for (std::size_t i = 0; i < below_ceiling_.size(); ++i) {
    const double points = static_cast<double>(i) - static_cast<double>(kPoints);
    below_ceiling_[i] = static_cast<float>(
        normal_cumulative(-points * FrictionGrid::kStep / parameters.ceiling_deviation));
  }
  for (std::size_t i = 0; i < kPoints; ++i) {
    stick_factor_[i] = static_cast<float>(
        std::pow(FrictionGrid::at(static_cast<double>(i)), -parameters.stick_exponent));
  }
}

const FrictionLikelihood::Width& FrictionLikelihood::width_of(double deviation) const {
  for (const Width& width : widths_) {
    if (deviation <= width.deviation * 1.19) return width;  // The next is 1.41 as wide.
  }
  return widths_.back();
}

void FrictionLikelihood::add_slip_or_stick(const std::vector<ObservedRatio>& pillars,
                                           double effective, FrictionEvidence& evidence) const {
  if (pillars.empty()) return;
  const double slips = parameters_.slip_probability * (1 - parameters_.outliers);
  const double sticks = (1 - parameters_.slip_probability) * (1 - parameters_.outliers);
  Factors estimate = kOnes;
  Factors cautious = kOnes;
  for (const ObservedRatio& pillar : pillars) {
    const Width& width = width_of(pillar.deviation);
    const std::size_t at = kPoints - FrictionGrid::nearest(pillar.ratio);
    const std::size_t ceiling = FrictionGrid::nearest(pillar.ceiling);
    multiply(estimate, cautious,
             {width.density.data() + at, width.cumulative.data() + at,
              below_ceiling_.data() + kPoints - ceiling,
              static_cast<float>(slips / std::max(FrictionGrid::kLeast, pillar.ratio)),
              static_cast<float>(sticks), stick_factor_[ceiling],
              static_cast<float>(parameters_.outliers / kOutlierRange)},
             stick_factor_);
  }
  const double weight = weight_of(pillars.size(), effective);
  add_logarithm(estimate, weight, evidence.estimate);
  add_logarithm(cautious, weight, evidence.cautious);
}

void FrictionLikelihood::add_lower_bounds(const std::vector<ObservedRatio>& pillars,
                                          double effective, FrictionEvidence& evidence) const {
  if (pillars.empty()) return;
  Factors product = kOnes;
  for (const ObservedRatio& pillar : pillars) {
    const std::size_t at = kPoints - FrictionGrid::nearest(pillar.ratio);
    multiply(product, width_of(pillar.deviation).cumulative.data() + at,
             static_cast<float>(parameters_.outliers));
  }
  FrictionCurve logarithm{};
  add_logarithm(product, weight_of(pillars.size(), effective), logarithm);
  for (std::size_t i = 0; i < kPoints; ++i) {
    evidence.estimate[i] += logarithm[i];
    evidence.cautious[i] += logarithm[i];
  }
}

}  // namespace pillarfield
