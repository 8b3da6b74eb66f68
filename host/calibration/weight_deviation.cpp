// Effect of a WeightFit's errors on other weights on other bases.

#include <algorithm>
#include <cmath>
#include <random>

#include "base/quantile.h"
#include "calibration/weight_fit.h"

namespace pillarfield {
namespace {

/// Other bodies: their load and the length of their base, relative to those of the weight.
constexpr double kLeastLoad = 0.3;
constexpr double kMostLoad = 2;
constexpr double kLeastBase = 0.7;
constexpr double kMostBase = 1.4;
constexpr int kBodiesPerDraw = 64;

/// A part of a body's load on a sensel.
struct LoadPart {
  std::size_t sensel;
  double share;
  double log_reading;  ///< relative to the reference
  double noise;        ///< deviation, relative to the share
  bool is_lost;        ///< below the threshold
};

/// Bodies like the weight in a frame, elsewhere.
class OtherBodies {
 public:
  explicit OtherBodies(const WeightFit& fit)
      : fit_(fit),
        array_(fit.array()),
        heaviest_n_(std::ranges::max(fit.frames(), {}, &WeighedFrame::weight_n).weight_n) {}

  [[nodiscard]] double uniform() { return distribution_(random_); }
  [[nodiscard]] double normal() { return normal_(random_); }

  /// Fills the parts of a body.
  void draw(std::vector<LoadPart>& parts) {
    const WeighedFrame& frame = frame_at(uniform());
    std::uint32_t top = array_.rows;
    std::uint32_t left = array_.cols;
    std::uint32_t bottom = 0;
    std::uint32_t right = 0;
    for (const auto& [i, reading] : frame.readings) {
      if (!(reading > array_.threshold)) continue;
      top = std::min(top, i / array_.cols);
      bottom = std::max(bottom, i / array_.cols);
      left = std::min(left, i % array_.cols);
      right = std::max(right, i % array_.cols);
    }
    double base = kLeastBase + uniform() * (kMostBase - kLeastBase);
    const double largest = std::min((array_.rows - 1.0) / std::max(1U, bottom - top),
                                    (array_.cols - 1.0) / std::max(1U, right - left));
    base = std::min(base, largest);
    const double row = uniform() * (array_.rows - 1 - base * (bottom - top));
    const double col = uniform() * (array_.cols - 1 - base * (right - left));
    const double load = kLeastLoad * std::pow(kMostLoad / kLeastLoad, uniform());
    const double log_pressure =
        std::log(load * heaviest_n_ / (frame.weight_n * base * base)) / fit_.response().exponent;
    parts.clear();
    double sum = 0;
    for (const auto& [i, reading] : frame.readings) {
      if (!(reading > array_.threshold)) continue;
      const std::uint32_t from_row = i / array_.cols;
      const std::uint32_t from_col = i % array_.cols;
      const auto at_row =
          static_cast<std::size_t>(std::lround(row + base * static_cast<double>(from_row - top)));
      const auto at_col =
          static_cast<std::size_t>(std::lround(col + base * static_cast<double>(from_col - left)));
      const double corrected = std::exp(fit_.log_gains()[i]) * reading;
      const double share = fit_.response().at(corrected).load;
      const double log_reading = std::log(corrected / fit_.response().reference) + log_pressure;
      const double size = fit_.response().reference * std::exp(log_reading);
      // A wider base has more sensels, each with less of the noise.
      const double noise = fit_.response().exponent * array_.noise[i] / (size * base);
      parts.push_back(
          {at_row * array_.cols + at_col, share, log_reading, noise, size < array_.threshold});
      sum += share;
    }
    for (LoadPart& part : parts) part.share /= sum;
  }

 private:
  [[nodiscard]] const WeighedFrame& frame_at(double part) const {
    const std::size_t count = fit_.frames().size();
    return fit_
        .frames()[std::min(count - 1, static_cast<std::size_t>(part * static_cast<double>(count)))];
  }

  const WeightFit& fit_;
  const WeighedArray& array_;
  double heaviest_n_;
  std::mt19937_64 random_{1};
  std::uniform_real_distribution<double> distribution_;
  std::normal_distribution<double> normal_;
};

}  // namespace

WeightDeviations deviations_of(const WeightFit& fit, int samples) {
  OtherBodies bodies(fit);
  const std::size_t count = fit.log_gains().size();
  WeightDeviations result;
  result.gains.assign(count, 0);
  std::vector<double> totals;
  double elements = 0;
  std::vector<double> independent(count + 2);
  std::vector<LoadPart> parts;
  for (int sample = 0; sample < samples; ++sample) {
    for (double& value : independent) value = bodies.normal();
    const WeightFit::Errors errors = fit.draw(independent);
    for (std::size_t i = 0; i < count; ++i) {
      result.gains[i] += errors.log_gains[i] * errors.log_gains[i] / samples;
    }
    for (int body = 0; body < kBodiesPerDraw; ++body) {
      bodies.draw(parts);
      double total = 0;
      double variance = fit.misfit() * fit.misfit();
      for (const LoadPart& part : parts) {
        const double error = fit.response().exponent * errors.log_gains[part.sensel] +
                             errors.exponent * part.log_reading - errors.log_counts_per_newton;
        if (!part.is_lost) total += part.share * std::exp(error);
        variance += part.share * part.share * part.noise * part.noise;
        elements += part.share * error * error / (samples * kBodiesPerDraw);
      }
      totals.push_back(std::abs(total - 1 + std::sqrt(variance) * bodies.normal()));
    }
  }
  for (double& gain : result.gains) gain = std::sqrt(gain);
  result.total = quantile(totals, 0.95) / 1.96;
  result.element = std::hypot(std::sqrt(elements), fit.misfit());
  return result;
}

}  // namespace pillarfield
