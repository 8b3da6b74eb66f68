#include "calibration/weight_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

#include "base/quantile.h"
#include "calibration/golden_section.h"

namespace pillarfield {
namespace {

/// Standard deviations before the frames are seen: of a logarithmic gain, and of the logarithm of
/// the exponent.
constexpr double kGainSpread = 0.25;
constexpr double kLeastGainSpread = 0.01;
constexpr double kMostGainSpread = 0.5;
constexpr double kExponentSpread = 0.3;
/// Range of the exponent relative to the one before.
constexpr double kMostExponentChange = 2.5;
constexpr double kExponentStep = 1e-3;
/// Least relative misfit, common to the frames at a place: sensels are no exact squares.
constexpr double kLeastMisfit = 1e-3;
/// Relative error of the load on missing sensels, taken from those beside them.
constexpr double kGuessError = 0.3;
/// Tukey's biweight leaves out residuals beyond this many deviations.
constexpr double kBiweight = 4.685;
constexpr double kMedianToDeviation = 1.4826;
/// Loads of which deviations are stated, relative to the weight.
constexpr double kLeastLoad = 0.3;
constexpr double kMostLoad = 2;
constexpr int kPlacesPerSample = 32;

double squared(double value) { return value * value; }

double product(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double spread_of(std::vector<double> values) {
  const double middle = median(values);
  for (double& value : values) value = std::abs(value - middle);
  return kMedianToDeviation * median(values);
}

}  // namespace

WeightResponse::Point WeightResponse::at(double reading) const {
  const double size = std::abs(reading);
  if (size < 1e-9) return {0, 0};
  if (curve.empty()) {
    const double load = std::copysign(reference * std::pow(size / reference, exponent), reading);
    return {load, exponent * load};
  }
  constexpr double kStep = 1e-3;
  const double rise = load_at(curve, size * (1 + kStep)) - load_at(curve, size * (1 - kStep));
  return {std::copysign(load_at(curve, size), reading), std::copysign(rise / (2 * kStep), reading)};
}

WeightFit::WeightFit(std::span<const WeighedFrame> frames, WeighedArray array,
                     WeightResponse response)
    : frames_(frames),
      array_(std::move(array)),
      response_(std::move(response)),
      first_exponent_(response_.exponent),
      begins_(1, 0),
      x_(array_.noise.size(), 0.0),
      spread_(kGainSpread),
      residuals_(frames.size()),
      noise_squares_(frames.size()),
      exponent_slopes_(frames.size()),
      weights_(frames.size()) {
  for (const WeighedFrame& frame : frames)
    begins_.push_back(begins_.back() + frame.readings.size());
  slopes_.resize(begins_.back());
}

/// Residuals of log(sum of V / weight), and their slopes in x and in the exponent.
void WeightFit::linearise() {
  std::vector<double> gains(x_.size());
  std::ranges::transform(x_, gains.begin(), [](double x) { return std::exp(x); });
  for (std::size_t t = 0; t < frames_.size(); ++t) {
    double sum = 0;
    double noise = 0;
    double exponent_slope = 0;
    double* slope = &slopes_[begins_[t]];
    for (const auto& [i, raw] : frames_[t].readings) {
      const double reading = gains[i] * raw;
      const auto [load, rise] = response_.at(reading);
      const double copies = array_.copies[i];
      *slope++ = copies * rise;
      sum += copies * load;
      const double sigma = gains[i] * array_.noise[i];
      // The slope of a reading within the noise is that at the noise.
      const bool quiet = std::abs(reading) < sigma;
      const double steep = quiet ? response_.at(sigma).slope / sigma : rise / reading;
      noise += squared(copies * steep * sigma);
      if (load != 0) {
        exponent_slope += copies * load * std::log(std::abs(reading) / response_.reference);
      }
    }
    sum = std::max(sum, 1e-9);
    for (std::size_t i = begins_[t]; i < begins_[t + 1]; ++i) slopes_[i] /= sum;
    residuals_[t] = std::log(sum / frames_[t].weight_n);
    noise_squares_[t] = noise / squared(sum);
    exponent_slopes_[t] = exponent_slope / sum;
  }
}

double WeightFit::variance(std::size_t frame) const {
  return noise_squares_[frame] + squared(kGuessError * frames_[frame].guessed) +
         frames_[frame].frames_at_place * squared(misfit_);
}

void WeightFit::estimate_misfit() {
  std::vector<double> noise = noise_squares_;
  misfit_ =
      std::sqrt(std::max(squared(kLeastMisfit), squared(spread_of(residuals_)) - median(noise)));
}

/// Weights of the frames, and the counts per newton.
void WeightFit::weigh(bool first) {
  if (first) {
    std::vector<double> residuals = residuals_;
    log_k_ = median(residuals);
  }
  for (int round = 0; round < 3; ++round) {
    double sum = 0;
    double weights = 0;
    for (std::size_t t = 0; t < frames_.size(); ++t) {
      const double spread = variance(t);
      // Residuals are compared with the deviation of their frame, information with that of places.
      const double deviation = spread - (frames_[t].frames_at_place - 1) * squared(misfit_);
      const double u = squared(residuals_[t] - log_k_) / (squared(kBiweight) * deviation);
      weights_[t] = u < 1 ? squared(1 - u) / spread : 0;
      sum += weights_[t] * residuals_[t];
      weights += weights_[t];
    }
    if (weights > 0) log_k_ = sum / weights;
  }
}

double WeightFit::objective() const {
  double sum = product(x_, x_) / squared(spread_) +
               squared(std::log(response_.exponent / first_exponent_) / kExponentSpread);
  for (std::size_t t = 0; t < frames_.size(); ++t) {
    const double spread = variance(t);
    const double deviation = spread - (frames_[t].frames_at_place - 1) * squared(misfit_);
    const double u = squared(residuals_[t] - log_k_) / (squared(kBiweight) * deviation);
    const double loss = u < 1 ? 1 - (1 - u) * (1 - u) * (1 - u) : 1;
    sum += squared(kBiweight) / 3 * loss * deviation / spread;
  }
  return sum;
}

double WeightFit::weighted_mean(std::span<const double> of_frames) const {
  return product(weights_, of_frames) / std::accumulate(weights_.begin(), weights_.end(), 0.0);
}

/// Weighted values less their mean, which the counts per newton take.
std::vector<double> WeightFit::centred(std::span<const double> of_frames) const {
  const double mean = weighted_mean(of_frames);
  std::vector<double> values(of_frames.size());
  for (std::size_t t = 0; t < values.size(); ++t) values[t] = weights_[t] * (of_frames[t] - mean);
  return values;
}

std::vector<double> WeightFit::gradient(std::span<const double> of_frames) const {
  std::vector<double> sums(x_.size(), 0);
  for (std::size_t t = 0; t < frames_.size(); ++t) {
    const double* slope = &slopes_[begins_[t]];
    for (const WeighedReading& each : frames_[t].readings) {
      sums[each.sensel] += *slope++ * of_frames[t];
    }
  }
  return sums;
}

std::vector<double> WeightFit::along(std::span<const double> x) const {
  std::vector<double> changes(frames_.size(), 0);
  for (std::size_t t = 0; t < frames_.size(); ++t) {
    const double* slope = &slopes_[begins_[t]];
    for (const WeighedReading& each : frames_[t].readings) changes[t] += *slope++ * x[each.sensel];
  }
  return changes;
}

/// Conjugate gradients of the normal equations of x, with the prior.
std::vector<double> WeightFit::solve(const std::vector<double>& right) const {
  constexpr int kMostSteps = 300;
  constexpr double kAccuracy = 1e-5;
  const double prior = 1 / squared(spread_);
  std::vector<double> diagonal(x_.size(), prior);
  for (std::size_t t = 0; t < frames_.size(); ++t) {
    const double* slope = &slopes_[begins_[t]];
    for (const WeighedReading& each : frames_[t].readings) {
      diagonal[each.sensel] += weights_[t] * squared(*slope++);
    }
  }
  std::vector<double> x(x_.size(), 0);
  std::vector<double> rest = right;
  std::vector<double> direction(x_.size(), 0);
  std::vector<double> scaled(x_.size());
  double before = 0;
  double first = 0;
  for (int step = 0; step < kMostSteps; ++step) {
    for (std::size_t i = 0; i < x.size(); ++i) scaled[i] = rest[i] / diagonal[i];
    const double now = product(rest, scaled);
    if (step == 0) first = now;
    if (!(now > squared(kAccuracy) * first)) break;
    const double keep = step == 0 ? 0 : now / before;
    for (std::size_t i = 0; i < x.size(); ++i) direction[i] = scaled[i] + keep * direction[i];
    std::vector<double> image = gradient(centred(along(direction)));
    for (std::size_t i = 0; i < x.size(); ++i) image[i] += prior * direction[i];
    const double length = now / product(direction, image);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] += length * direction[i];
      rest[i] -= length * image[i];
    }
    before = now;
  }
  return x;
}

/// Fits x at an exponent, from where x is.
double WeightFit::at_exponent(double exponent, int rounds) {
  constexpr double kMostLogGain = 1.5;
  response_.exponent = exponent;
  linearise();
  weigh(true);
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> right = gradient(centred(residuals_));
    for (std::size_t i = 0; i < x_.size(); ++i) right[i] = -right[i] - x_[i] / squared(spread_);
    const std::vector<double> change = solve(right);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      x_[i] = std::clamp(x_[i] + change[i], -kMostLogGain, kMostLogGain);
    }
    linearise();
    weigh(false);
  }
  return objective();
}

void WeightFit::search_exponent(double low, double high) {
  const auto at = [&](double log_exponent) { return at_exponent(std::exp(log_exponent), 2); };
  const double best = least_of(at, std::log(low), std::log(high), kExponentStep);
  (void)at_exponent(std::exp(best), 3);
}

void WeightFit::fit_once(bool exponent) {
  (void)at_exponent(response_.exponent, 3);
  for (const double reach : {kMostExponentChange, 1.3, 1.1}) {
    estimate_misfit();
    if (exponent) {
      const double low =
          std::max(response_.exponent / reach, first_exponent_ / kMostExponentChange);
      const double high =
          std::min(response_.exponent * reach, first_exponent_ * kMostExponentChange);
      search_exponent(low, high);
    } else {
      (void)at_exponent(response_.exponent, 3);
    }
  }
  estimate_misfit();
  (void)at_exponent(response_.exponent, 2);
}

void WeightFit::fit(bool exponent) {
  linearise();
  weigh(true);
  estimate_misfit();
  first_misfit_ = misfit_;
  fit_once(exponent);
  // The spread between sensels that the visited ones show.
  constexpr int kSpreadSamples = 12;
  for (int round = 0; round < 2; ++round) {
    const std::vector<double> deviation = deviations(kSpreadSamples).gains;
    double squares = 0;
    double count = 0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (deviation[i] > 0.9 * spread_) continue;
      squares += squared(x_[i]) + squared(deviation[i]);
      ++count;
    }
    if (count < 1) break;
    spread_ = std::clamp(std::sqrt(squares / count), kLeastGainSpread, kMostGainSpread);
    (void)at_exponent(response_.exponent, 2);
  }
  if (exponent) search_exponent(response_.exponent / 1.1, response_.exponent * 1.1);
}

void WeightFit::keep_exponent(double exponent, double deviation) {
  kept_deviation_ = deviation;
  response_.exponent = exponent;
  estimate_misfit();
  for (int round = 0; round < 3; ++round) {
    (void)at_exponent(exponent, 3);
    estimate_misfit();
  }
}

double WeightFit::exponent_deviation() const {
  if (kept_deviation_ >= 0) return kept_deviation_;
  const std::vector<double> weighed = centred(exponent_slopes_);
  const std::vector<double> along_x = gradient(weighed);
  const double information = product(weighed, exponent_slopes_) - product(along_x, solve(along_x)) +
                             1 / squared(response_.exponent * kExponentSpread);
  return 1 / std::sqrt(std::max(information, 1e-12));
}

WeightFit::Deviations WeightFit::deviations(int samples) const {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const double exponent_deviation = this->exponent_deviation();
  const std::vector<double> bend = solve(gradient(centred(exponent_slopes_)));
  const auto below = [&](std::size_t count) {
    return std::min(count - 1,
                    static_cast<std::size_t>(uniform(random) * static_cast<double>(count)));
  };
  Deviations result;
  result.gains.assign(x_.size(), 0);
  double totals = 0;
  double elements = 0;
  double slopes = 0;
  std::vector<double> errors(frames_.size());
  for (int sample = 0; sample < samples; ++sample) {
    for (std::size_t t = 0; t < errors.size(); ++t) {
      errors[t] = weights_[t] > 0 ? normal(random) / std::sqrt(weights_[t]) : 0;
    }
    std::vector<double> right = gradient(centred(errors));
    for (double& value : right) value += normal(random) / spread_;
    std::vector<double> x = solve(right);
    const double exponent = exponent_deviation * normal(random);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] -= bend[i] * exponent;
      result.gains[i] += squared(x[i]) / samples;
    }
    const double log_k = weighted_mean(along(x)) + weighted_mean(exponent_slopes_) * exponent;
    for (int place = 0; place < kPlacesPerSample; ++place) {
      const std::size_t t = below(frames_.size());
      const auto& readings = frames_[t].readings;
      std::uint32_t top = array_.rows;
      std::uint32_t left = array_.cols;
      std::uint32_t bottom = 0;
      std::uint32_t right_most = 0;
      for (const WeighedReading& each : readings) {
        top = std::min(top, each.sensel / array_.cols);
        bottom = std::max(bottom, each.sensel / array_.cols);
        left = std::min(left, each.sensel % array_.cols);
        right_most = std::max(right_most, each.sensel % array_.cols);
      }
      const std::size_t row = below(array_.rows - (bottom - top));
      const std::size_t col = below(array_.cols - (right_most - left));
      const double log_load =
          std::log(kLeastLoad) + uniform(random) * std::log(kMostLoad / kLeastLoad);
      const double shift = log_load / response_.exponent;
      double total = 0;
      for (std::size_t n = 0; n < readings.size(); ++n) {
        const std::uint32_t i = readings[n].sensel;
        const std::size_t at =
            (i / array_.cols - top + row) * array_.cols + i % array_.cols - left + col;
        const double slope = slopes_[begins_[t] + n];
        total += slope * x[at];
        const double size = std::abs(std::exp(x_[i]) * readings[n].reading) + 1e-9;
        const double element = response_.exponent * x[at] - log_k +
                               exponent * (std::log(size / response_.reference) + shift);
        elements += std::abs(slope) * squared(element);
        slopes += std::abs(slope);
      }
      totals += squared(total + exponent * (exponent_slopes_[t] + shift) - log_k) /
                (samples * kPlacesPerSample);
    }
  }
  for (double& gain : result.gains) gain = std::sqrt(gain);
  result.total = std::sqrt(totals + squared(misfit_));
  result.element = std::sqrt(elements / slopes + squared(misfit_));
  return result;
}

}  // namespace pillarfield
