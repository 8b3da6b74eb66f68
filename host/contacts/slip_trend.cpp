#include "contacts/slip_trend.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pillarfield {
namespace {

// The weight of a frame falls by e in these times, or in kMemoryFrames if that takes longer.
constexpr double kPresentS = 0.1;
constexpr double kLastingS = 0.5;
constexpr double kMemoryFrames = 4;
constexpr int kLeastOfTrend = 4;
constexpr double kRateChange = 0.2;  // relative standard deviation of a rate until slip
constexpr double kEndsDeviations = 1.96;

double normal_probability(double deviations) {
  return 0.5 * std::erfc(-deviations / std::numbers::sqrt2);
}

}  // namespace

/// Fades the earlier frames, from the new one on.
void SlipTrend::Line::advance(double step_s, double change, double memory_s) {
  const double fade = std::exp(-step_s / std::max(memory_s, kMemoryFrames * step_s));
  products = fade * (products - step_s * ratios - change * times + step_s * change * weights);
  time_squares = fade * (time_squares - 2 * step_s * times + step_s * step_s * weights);
  ratio_squares = fade * (ratio_squares - 2 * change * ratios + change * change * weights);
  times = fade * (times - step_s * weights);
  ratios = fade * (ratios - change * weights);
  weights *= fade;
}

/// Variance of a frame about the line.
double SlipTrend::Line::noise() const {
  const double slope = rate();
  const double residual = ratio_squares - ratios * ratios / weights - slope * slope * spread();
  return std::max(residual, 0.0) / std::max(weights - 2, 1.0);
}

void SlipTrend::add(double time_s, double ratio) {
  const double step_s = time_s - time_s_;
  if (frames_ > 0 && !(step_s > 0)) *this = {};
  if (frames_ > 0) {
    present_.advance(step_s, ratio - ratio_, kPresentS);
    lasting_.advance(step_s, ratio - ratio_, kLastingS);
  }
  ++present_.weights;
  ++lasting_.weights;
  ++frames_;
  time_s_ = time_s;
  ratio_ = ratio;
}

std::optional<SlipForecast> SlipTrend::forecast(double friction, double deviation) const {
  if (frames_ < kLeastOfTrend) return std::nullopt;
  // A swing or a jump has a rate that does not last.
  const Line& line = lasting_.rate() < present_.rate() ? lasting_ : present_;
  const double rate = line.rate();
  const double rate_variance =
      line.noise() / line.spread() + kRateChange * kRateChange * rate * rate;
  const double noise = present_.noise() / present_.weights;
  const double variance = deviation * deviation + noise;
  const double ratio =
      ratio_ + (present_.ratios - present_.rate() * present_.times) / present_.weights;
  const double left = friction - ratio;

  // P(slip within t) = Phi((rate t - left) / sqrt(variance + rate_variance t^2)).
  SlipForecast found;
  for (std::size_t i = 0; i < found.probability.size(); ++i) {
    const double t = SlipForecast::kWithinS[i];
    const double sigma = std::sqrt(variance + rate_variance * t * t);
    found.probability[i] = normal_probability((rate * t - left) / sigma);
  }
  if (left <= 0) {
    found.time_s = 0;
  } else if (rate > 0) {
    found.time_s = left / rate;
  }
  const double z = kEndsDeviations * kEndsDeviations;
  const double a = rate * rate - z * rate_variance;
  const double c = left * left - z * variance;
  const double root = std::sqrt(std::max(rate * rate * left * left - a * c, 0.0));
  const bool already = c <= 0 || left <= 0;  // the interval of the friction holds the ratio
  if (already) found.low_s = 0;
  if (!already && (a < 0 || rate > 0)) found.low_s = c / (rate * left + root);
  if (a > 0 && rate > 0) found.high_s = std::max((rate * left + root) / a, 0.0);
  return found;
}

}  // namespace pillarfield
