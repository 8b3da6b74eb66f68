#include "contacts/estimator/friction_likelihood.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "base/log_exp.h"
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
PF_WIDE void add_logarithm(const Factors& product, double weight, FrictionCurve& log_likelihood) {
  for (std::size_t i = 0; i < kPoints; ++i) {
    log_likelihood[i] += weight * fast_log(std::max(product[i], 1e-300));
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

/// Pillars whose factors are multiplied as floats: above 1e-4 each, their product is one.
constexpr std::size_t kBatch = 8;

/// Points at a time, whose products stay in registers.
constexpr std::size_t kBlock = 16;
static_assert(kPoints % kBlock == 0);
using Block = std::array<float, kBlock>;

PF_WIDE_INLINE void multiply(const Block& factors, std::size_t at, Factors& product) {
  for (std::size_t i = 0; i < kBlock; ++i) product[at + i] *= static_cast<double>(factors[i]);
}

PF_WIDE void multiply(Factors& estimate, Factors& cautious, std::span<const SlipOrStick> pillars,
                      const Powers& stick_factor) {
  for (std::size_t at = 0; at < kPoints; at += kBlock) {
    Block estimates;
    Block cautions;
    estimates.fill(1);
    cautions.fill(1);
    for (const SlipOrStick& pillar : pillars) {
      for (std::size_t i = 0; i < kBlock; ++i) {
        const float factor = std::max(stick_factor[at + i], pillar.least_factor);
        const float slips =
            pillar.slip * pillar.density[at + i] * pillar.below_ceiling[at + i] + pillar.outlier;
        const float sticks = pillar.stick * pillar.cumulative[at + i];
        estimates[i] *= slips + factor * sticks;
        cautions[i] *= slips + sticks;
      }
    }
    multiply(estimates, at, estimate);
    multiply(cautions, at, cautious);
  }
}

PF_WIDE void multiply(Factors& product, std::span<const float* const> cumulative, float outliers) {
  for (std::size_t at = 0; at < kPoints; at += kBlock) {
    Block factors;
    factors.fill(1);
    for (const float* const pillar : cumulative) {
      for (std::size_t i = 0; i < kBlock; ++i)
        factors[i] *= pillar[at + i] * (1 - outliers) + outliers;
    }
    multiply(factors, at, product);
  }
}

/// Calls `use` with the terms of up to kBatch pillars at a time.
template <class Term, class Pillars, class TermOf, class Use>
void for_each_batch(const Pillars& pillars, TermOf term_of, Use use) {
  std::array<Term, kBatch> terms{};
  for (std::size_t first = 0; first < pillars.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, pillars.size() - first);
    for (std::size_t i = 0; i < count; ++i) terms[i] = term_of(pillars[first + i]);
    use(std::span(terms).first(count));
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
  const auto terms_of = [&](const ObservedRatio& pillar) {
    const Width& width = width_of(pillar.deviation);
    const std::size_t at = kPoints - FrictionGrid::nearest(pillar.ratio);
    const std::size_t ceiling = FrictionGrid::nearest(pillar.ceiling);
    return SlipOrStick{width.density.data() + at,
                       width.cumulative.data() + at,
                       below_ceiling_.data() + kPoints - ceiling,
                       static_cast<float>(slips / std::max(FrictionGrid::kLeast, pillar.ratio)),
                       static_cast<float>(sticks),
                       stick_factor_[ceiling],
                       static_cast<float>(parameters_.outliers / kOutlierRange)};
  };
  for_each_batch<SlipOrStick>(pillars, terms_of, [&](std::span<const SlipOrStick> batch) {
    multiply(estimate, cautious, batch, stick_factor_);
  });
  const double weight = weight_of(pillars.size(), effective);
  add_logarithm(estimate, weight, evidence.estimate);
  add_logarithm(cautious, weight, evidence.cautious);
}

void FrictionLikelihood::add_lower_bounds(const std::vector<ObservedRatio>& pillars,
                                          double effective, FrictionEvidence& evidence) const {
  if (pillars.empty()) return;
  Factors product = kOnes;
  const auto cumulative_of = [&](const ObservedRatio& pillar) {
    const std::size_t at = kPoints - FrictionGrid::nearest(pillar.ratio);
    return width_of(pillar.deviation).cumulative.data() + at;
  };
  for_each_batch<const float*>(pillars, cumulative_of, [&](std::span<const float* const> batch) {
    multiply(product, batch, static_cast<float>(parameters_.outliers));
  });
  FrictionCurve logarithm{};
  add_logarithm(product, weight_of(pillars.size(), effective), logarithm);
  for (std::size_t i = 0; i < kPoints; ++i) {
    evidence.estimate[i] += logarithm[i];
    evidence.cautious[i] += logarithm[i];
  }
}

}  // namespace pillarfield
