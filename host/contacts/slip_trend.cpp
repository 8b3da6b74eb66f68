#include "contacts/slip_trend.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pillarfield {
namespace {

// The weight of a frame falls by e in kMemoryS, or in kMemoryFrames if that takes longer.
constexpr double kMemoryS = 0.1;
constexpr double kMemoryFrames = 4;
constexpr int kLeastOfTrend = 4;
constexpr double kRatioNoise = 0.004;     // least standard deviation of a ratio about its trend
constexpr double kTurnDeviations = 2.25;  // from the trend, of a frame that begins another
constexpr double kRateChange = 0.4;       // relative standard deviation of a rate until slip
constexpr double kSwingFall = 0.05;       // fraction of a peak by which a swing falls
constexpr double kSwingRise = 0.03;       // fraction by which a load exceeds the swings before
constexpr double kSwingMemoryS = 5;       // age of a swing that counts
constexpr double kSwingGoesOn = 0.4;      // probability that a load exceeds the swings before
constexpr double kEndsDeviations = 1.96;

double normal_probability(double deviations) {
  return 0.5 * std::erfc(-deviations / std::numbers::sqrt2);
}

}  // namespace

/// True if a frame so far from the newest one does not continue the trend.
bool SlipTrend::turns(double step_s, double change) const {
  if (line_.weights() < 2) return false;  // Two points are on any line.
  const double away = change - (line_.height() + line_.slope() * step_s);
  return away * away >
         kTurnDeviations * kTurnDeviations * (line_.noise() + kRatioNoise * kRatioNoise);
}

/// Updates the largest ratio of swings.
void SlipTrend::remember_swing() {
  if (ratio_ < (1 - kSwingFall) * peak_) {
    swing_ = std::max(swing_, peak_);
    swing_s_ = time_s_;
    peak_ = ratio_;
  }
  peak_ = std::max(peak_, ratio_);
  if (ratio_ > (1 + kSwingRise) * swing_ || time_s_ - swing_s_ > kSwingMemoryS) swing_ = 0;
}

void SlipTrend::add(double time_s, double ratio) {
  if (frames_ > 0 && !(time_s > time_s_)) *this = {};
  const double step_s = frames_ > 0 ? time_s - time_s_ : 0;
  const double change = ratio - ratio_;
  if (turns(step_s, change)) {
    line_ = {};
    line_.add(0, 0, 1);  // the frame before
  }
  line_.add(step_s, change, std::max(kMemoryS, kMemoryFrames * step_s));
  ++frames_;
  time_s_ = time_s;
  ratio_ = ratio;
  remember_swing();
}

std::optional<SlipForecast> SlipTrend::forecast(double friction, double deviation) const {
  if (frames_ < kLeastOfTrend) return std::nullopt;
  const double rate = line_.slope();
  const double noise = line_.noise() + kRatioNoise * kRatioNoise;
  const double rate_variance = noise / line_.spread() + kRateChange * kRateChange * rate * rate;
  const double variance = deviation * deviation + noise / line_.weights();
  const double left = friction - (ratio_ + line_.height());
  const bool slides = left <= 0;
  const bool swings = swing_ > 0 && !slides;
  const double goes_on = swings ? kSwingGoesOn : 1;

  // P(slip within t): the largest of Phi((rate t - left) / sqrt(variance + rate_variance t^2)) from
  // now until then, if it goes on.
  SlipForecast found;
  double largest = normal_probability(-left / std::sqrt(variance));
  for (std::size_t i = 0; i < found.probability.size(); ++i) {
    const double t = SlipForecast::kWithinS[i];
    const double sigma = std::sqrt(variance + rate_variance * t * t);
    largest = std::max(largest, normal_probability((rate * t - left) / sigma));
    found.probability[i] = goes_on * largest;
  }
  const double z = kEndsDeviations * kEndsDeviations;
  const double a = rate * rate - z * rate_variance;
  const double c = left * left - z * variance;
  if (slides) found.time_s = 0;
  if (slides || c <= 0) found.low_s = 0;   // the interval of the friction holds the ratio
  if (!(rate > 0 && a > 0)) return found;  // A load that may rest has no time.
  const double root = std::sqrt(std::max(rate * rate * left * left - a * c, 0.0));
  if (!found.low_s) found.low_s = c / (rate * left + root);
  if (swings) return found;
  found.time_s = std::max(left / rate, 0.0);
  found.high_s = std::max((rate * left + root) / a, 0.0);
  return found;
}

}  // namespace pillarfield
