#include "contacts/friction_evidence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pillarfield {
namespace {

constexpr std::size_t kPoints = FrictionGrid::kPoints;

/// Ratios from which likelihoods are densities: a pillar that follows no rule has one of these.
constexpr double kOutlierRange = 6;

/// So many factors of at least kOutlierRange's density have a product that is a normal number.
constexpr std::size_t kFactors = 48;

double normal_cumulative(double deviations) {
  return 0.5 * std::erfc(-deviations / std::numbers::sqrt2);
}

/// Multiplies likelihoods point by point and sums their logarithms now and then.
class LogProduct {
 public:
  LogProduct() { product_.fill(1); }

  FrictionCurve& next() {
    if (factors_++ == kFactors) flush();
    return product_;
  }

  void add_to(FrictionCurve& log_likelihood, double weight) {
    flush();
    for (std::size_t i = 0; i < kPoints; ++i) log_likelihood[i] += weight * logarithm_[i];
  }

 private:
  void flush() {
    for (std::size_t i = 0; i < kPoints; ++i) {
      logarithm_[i] += std::log(product_[i]);
      product_[i] = 1;
    }
    factors_ = 1;
  }

  FrictionCurve product_{};
  FrictionCurve logarithm_{};
  std::size_t factors_ = 0;
};

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
      width.density[i] = scale * std::exp(-0.5 * deviations * deviations);
      width.cumulative[i] = normal_cumulative(deviations);
    }
  }
  for (std::size_t i = 0; i < below_ceiling_.size(); ++i) {
    const double points = static_cast<double>(i) - static_cast<double>(kPoints);
    below_ceiling_[i] =
        normal_cumulative(-points * FrictionGrid::kStep / parameters.ceiling_deviation);
  }
  for (std::size_t i = 0; i < kPoints; ++i) {
    stick_factor_[i] =
        std::pow(FrictionGrid::at(static_cast<double>(i)), -parameters.stick_exponent);
  }
}

const FrictionLikelihood::Width& FrictionLikelihood::width_of(double deviation) const {
  for (const Width& width : widths_) {
    if (deviation <= width.deviation * 1.19) return width;
  }
  return widths_.back();
}

void FrictionLikelihood::add_slip_or_stick(const std::vector<ShownRatio>& pillars, double effective,
                                           FrictionCurve& log_likelihood) const {
  if (pillars.empty()) return;
  const double slips = parameters_.slip_probability * (1 - parameters_.outliers);
  const double sticks = (1 - parameters_.slip_probability) * (1 - parameters_.outliers);
  const double outlier = parameters_.outliers / kOutlierRange;
  LogProduct product;
  for (const ShownRatio& pillar : pillars) {
    const Width& width = width_of(pillar.deviation);
    const std::size_t at = kPoints - FrictionGrid::nearest(pillar.ratio);
    const double* const density = width.density.data() + at;
    const double* const cumulative = width.cumulative.data() + at;
    const double* const below =
        below_ceiling_.data() + kPoints - FrictionGrid::nearest(pillar.ceiling);
    const double slip = slips / std::max(pillar.ratio, FrictionGrid::kLeast);
    const double least = std::pow(pillar.ceiling, -parameters_.stick_exponent);
    FrictionCurve& likelihood = product.next();
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double stick = sticks * std::max(stick_factor_[i], least);
      likelihood[i] *= slip * density[i] * below[i] + stick * cumulative[i] + outlier;
    }
  }
  product.add_to(log_likelihood, weight_of(pillars.size(), effective));
}

void FrictionLikelihood::add_lower_bounds(const std::vector<ShownRatio>& pillars, double effective,
                                          FrictionCurve& log_likelihood) const {
  if (pillars.empty()) return;
  LogProduct product;
  for (const ShownRatio& pillar : pillars) {
    const double* const cumulative = width_of(pillar.deviation).cumulative.data() + kPoints -
                                     FrictionGrid::nearest(pillar.ratio);
    FrictionCurve& likelihood = product.next();
    for (std::size_t i = 0; i < kPoints; ++i) {
      likelihood[i] *= cumulative[i] * (1 - parameters_.outliers) + parameters_.outliers;
    }
  }
  product.add_to(log_likelihood, weight_of(pillars.size(), effective));
}

}  // namespace pillarfield
