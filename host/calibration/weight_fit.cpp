#include "calibration/weight_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/quantile.h"

namespace pillarfield {
namespace {

/// Standard deviation of a logarithmic gain before the frames are seen.
constexpr double kGainSpread = 0.25;
constexpr double kLeastGainSpread = 0.01;
constexpr double kMostGainSpread = 0.5;
/// Least ratio of two weights whose sums tell the exponent from which a fit starts.
constexpr double kOtherWeight = 1.2;
/// Largest change of a step, and of the exponent's logarithm in all.
constexpr double kMostExponentStep = 0.15;
constexpr double kMostExponentChange = 0.9;
constexpr double kMostLogGain = 1.5;
/// Changes below which a fit ends.
constexpr double kAccurateExponent = 1e-3;
constexpr double kAccurateGain = 5e-3;
/// Least relative misfit, common to the frames at a place: sensels are no exact squares.
constexpr double kLeastMisfit = 1e-3;
/// Part of the sums' error that may follow the exponent's slopes, relative: errors of tares, noise
/// that bends at the rim of a contact.
constexpr double kAlongExponent = 1e-4;
/// Relative error of the variance of the noise.
constexpr double kNoiseError = 0.3;
/// Relative error of the load on missing sensels, taken from those beside them.
constexpr double kGuessError = 0.3;
/// Tukey's biweight leaves out residuals beyond this many deviations.
constexpr double kBiweight = 4.685;
constexpr double kMedianToDeviation = 1.4826;

double squared(double value) { return value * value; }

double product_of(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double robust_spread(std::vector<double> values) {
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
      noise_by_exponent_(frames.size()),
      exponent_noise_(frames.size()),
      weights_(frames.size()) {
  for (const WeighedFrame& frame : frames) {
    begins_.push_back(begins_.back() + frame.readings.size());
    const auto [first, last] = std::ranges::minmax(
        frame.readings, {}, [&](const WeighedReading& each) { return place(each.sensel); });
    reach_ = std::max(reach_, place(last.sensel) - place(first.sensel));
  }
  slopes_.resize(begins_.back());
  noise_slopes_.resize(begins_.back());
}

/// The place of a sensel in the equations: along the shorter side, so that contacts are narrow.
std::size_t WeightFit::place(std::uint32_t sensel) const {
  if (array_.cols <= array_.rows) return sensel;
  return std::size_t{sensel % array_.cols} * array_.rows + sensel / array_.cols;
}

/// Residuals of log(sum of V / weight), their slopes in x and in the exponent, and half the slopes
/// of the variance that the noise gives them.
void WeightFit::linearise() {
  std::vector<double> gains(x_.size());
  std::ranges::transform(x_, gains.begin(), [](double x) { return std::exp(x); });
  for (std::size_t t = 0; t < frames_.size(); ++t) {
    double sum = 0;
    double slope = 0;
    NoiseSums noise;
    std::size_t at = begins_[t];
    for (const auto& [i, raw] : frames_[t].readings) {
      const double reading = gains[i] * raw;
      const auto [load, rise] = response_.at(reading);
      const double copies = array_.copies[i];
      const double sigma = gains[i] * array_.noise[i];
      // A reading within the noise has the slopes at the noise.
      const double size = std::max({std::abs(reading), sigma, 1e-6});
      const WeightResponse::Point noisy = response_.at(size);
      const double log_reading = std::log(size / response_.reference);
      const double square = squared(copies * noisy.slope * sigma / size);
      const double by_exponent = noisy.load / noisy.slope + log_reading;
      slopes_[at] = copies * rise;
      noise_slopes_[at++] = square * noisy.slope / noisy.load;
      sum += copies * (load + array_.zone(i, raw));
      slope += copies * load * log_reading;
      noise.square += square;
      noise.by_exponent += square * by_exponent;
      noise.by_exponent_twice += square * squared(by_exponent);
    }
    sum = std::max(sum, 1e-9);
    for (std::size_t i = begins_[t]; i < at; ++i) {
      slopes_[i] /= sum;
      noise_slopes_[i] = noise_slopes_[i] / squared(sum) - slopes_[i] * noise.square / squared(sum);
    }
    slope /= sum;
    residuals_[t] = std::log(sum / frames_[t].weight_n);
    exponent_slopes_[t] = slope;
    noise_squares_[t] = noise.square / squared(sum);
    noise_by_exponent_[t] = noise.by_exponent / squared(sum) - slope * noise_squares_[t];
    exponent_noise_[t] = noise.by_exponent_twice / squared(sum) -
                         slope * (2 * noise_by_exponent_[t] + slope * noise_squares_[t]);
  }
}

/// Variance of a residual: by noise, guesses and misfit.
double WeightFit::variance(std::size_t frame) const {
  return noise_squares_[frame] + squared(kGuessError * frames_[frame].guessed) + squared(misfit_);
}

void WeightFit::estimate_misfit() {
  std::vector<double> noise = noise_squares_;
  misfit_ = std::sqrt(std::max(0.0, squared(robust_spread(residuals_)) - median(noise)));
}

/// Weights of the frames, and the counts per newton. The misfit is common to the frames at a place,
/// which share what one of them tells.
void WeightFit::weigh() {
  const double common = squared(std::max(misfit_, kLeastMisfit));
  std::vector<double> residuals = residuals_;
  log_k_ = median(residuals);
  for (int round = 0; round < 3; ++round) {
    double sum = 0;
    double weights = 0;
    for (std::size_t t = 0; t < frames_.size(); ++t) {
      const double own = variance(t) + squared(kLeastMisfit);
      const double u = squared((residuals_[t] - log_k_) / kBiweight) / own;
      weights_[t] = u < 1 ? squared(1 - u) / (own + frames_[t].frames_at_place * common) : 0;
      sum += weights_[t] * residuals_[t];
      weights += weights_[t];
    }
    if (weights > 0) log_k_ = sum / weights;
  }
}

WeightFit::Equations WeightFit::equations() const {
  const std::size_t count = x_.size();
  Equations all{BandedFactor(count, reach_),
                std::vector<double>(count),
                {std::vector<double>(count, 0), std::vector<double>(count, 0)},
                {},
                {}};
  const double prior = 1 / squared(spread_);
  for (std::uint32_t i = 0; i < count; ++i) {
    all.factor.add(place(i), place(i), prior);
    all.right[place(i)] = -prior * x_[i];
  }
  const double exponent_prior = 1 / squared(response_.exponent * kExponentSpread);
  all.shared[0] = exponent_prior;
  all.shared_right[0] =
      -exponent_prior * response_.exponent * std::log(response_.exponent / first_exponent_);
  std::vector<std::size_t> places;
  for (std::size_t t = 0; t < frames_.size(); ++t) {
    const double weight = weights_[t];
    if (weight == 0) continue;
    const double residual = residuals_[t] - log_k_;
    const std::array<double, 2> shared = {exponent_slopes_[t], -1};
    // Noise is in the slopes too: residual and slope have in common what is subtracted.
    all.shared_right[0] -= weight * (shared[0] * residual - noise_by_exponent_[t]);
    all.shared_right[1] += weight * residual;
    all.shared[0] += weight * squared(shared[0]);
    all.shared[1] += weight * shared[0] * shared[1];
    all.shared[2] += weight;
    const auto& readings = frames_[t].readings;
    const double* slope = &slopes_[begins_[t]];
    places.clear();
    for (const WeighedReading& each : readings) places.push_back(place(each.sensel));
    for (std::size_t a = 0; a < readings.size(); ++a) {
      const std::size_t at = places[a];
      const double weighed = weight * slope[a];
      all.right[at] -= weighed * residual - weight * noise_slopes_[begins_[t] + a];
      for (std::size_t s = 0; s < 2; ++s) all.beside.at(s)[at] += weighed * shared.at(s);
      for (std::size_t b = 0; b <= a; ++b) {
        const std::size_t other = places[b];
        all.factor.add(std::max(at, other), std::min(at, other), weighed * slope[b]);
      }
    }
  }
  all.factor.factorise();
  return all;
}

/// A Gauss-Newton step; a known exponent stays. Returns the largest change, relative to
/// those below which a fit ends.
double WeightFit::step() {
  const Equations all = equations();
  const std::vector<double> alone = all.factor.solve(all.right);
  const std::vector<double> by_exponent = all.factor.solve(all.beside[0]);
  const std::vector<double> by_k = all.factor.solve(all.beside[1]);
  const double ee = all.shared[0] - product_of(all.beside[0], by_exponent);
  const double ek = all.shared[1] - product_of(all.beside[0], by_k);
  const double kk = all.shared[2] - product_of(all.beside[1], by_k);
  const double e = all.shared_right[0] - product_of(all.beside[0], alone);
  const double k = all.shared_right[1] - product_of(all.beside[1], alone);
  double exponent = known_ ? 0 : (e * kk - k * ek) / (ee * kk - ek * ek);
  const double most = kMostExponentStep * response_.exponent;
  exponent = std::clamp(exponent, -most, most);
  const double log_k = (k - ek * exponent) / kk;
  double largest = std::abs(exponent) / kAccurateExponent;
  for (std::uint32_t i = 0; i < x_.size(); ++i) {
    const std::size_t at = place(i);
    const double change = alone[at] - by_exponent[at] * exponent - by_k[at] * log_k;
    x_[i] = std::clamp(x_[i] + change, -kMostLogGain, kMostLogGain);
    largest = std::max(largest, std::abs(change) / kAccurateGain);
  }
  response_.exponent =
      std::clamp(response_.exponent + exponent, first_exponent_ * std::exp(-kMostExponentChange),
                 first_exponent_ * std::exp(kMostExponentChange));
  return largest;
}

void WeightFit::settle(int steps) {
  for (int i = 0; i < steps; ++i) {
    linearise();
    estimate_misfit();
    weigh();
    if (step() < 1) break;
  }
  linearise();
  estimate_misfit();
  weigh();
}

/// The spread from sensel to sensel: without gains the sums vary from place to place by it and by
/// their noise.
void WeightFit::estimate_spread() {
  std::vector<double> slopes(x_.size(), 0);
  double slope_squares = 0;
  double sum = 0;
  double squares = 0;
  double count = 0;
  for (std::size_t t = 0; t < frames_.size(); ++t) {
    if (weights_[t] == 0) continue;
    double bare = residuals_[t];
    const double* slope = &slopes_[begins_[t]];
    for (const WeighedReading& each : frames_[t].readings) {
      bare -= *slope * x_[each.sensel];
      slopes[each.sensel] += *slope;
      slope_squares += squared(*slope++);
    }
    sum += bare;
    squares += squared(bare) - noise_squares_[t];
    ++count;
  }
  const double of_sums = squares - squared(sum) / count;
  const double of_one = slope_squares - product_of(slopes, slopes) / count;
  const double found = of_one > 0 ? std::sqrt(std::max(0.0, of_sums) / of_one) : 0;
  spread_ = std::clamp(found, kLeastGainSpread, kMostGainSpread);
}

/// Variance of the exponent from the information of the frames, part of which is their noise
/// that says nothing.
double WeightFit::exponent_variance(double information) const {
  const double unknown = squared(kExponentSpread * response_.exponent);
  double own = 0;
  double shift = 0;
  double weights = 0;
  for (std::size_t t = 0; t < frames_.size(); ++t) {
    own += weights_[t] * exponent_noise_[t];
    shift += weights_[t] * noise_by_exponent_[t];
    weights += weights_[t];
  }
  const double left = information - own;
  if (!(left > 0)) return unknown;
  const double variance = information / squared(left) + squared(kNoiseError * shift / left) +
                          squared(kAlongExponent) * weights / left;
  return std::min(variance, unknown);
}

/// The posterior at the fit.
void WeightFit::state_deviations() {
  posterior_.emplace(equations());
  const Equations& all = *posterior_;
  for (std::size_t s = 0; s < 2; ++s) responses_.at(s) = all.factor.solve(all.beside.at(s));
  const double ee = all.shared[0] - product_of(all.beside[0], responses_[0]);
  const double ek = all.shared[1] - product_of(all.beside[0], responses_[1]);
  const double kk = all.shared[2] - product_of(all.beside[1], responses_[1]);
  const double variance =
      known_ ? squared(known_->deviation) : exponent_variance(ee - squared(ek) / kk);
  // log k follows the exponent by -ek/kk.
  covariance_ = {variance, -ek / kk * variance, squared(ek / kk) * variance + 1 / kk};
  exponent_deviation_ = std::sqrt(variance);
}

/// The exponent by which the typical sums of the lightest and the heaviest weight differ as these
/// do: with another one the frames of one of them would be outliers. That before for one weight.
double WeightFit::start_exponent() const {
  const auto [light, heavy] = std::ranges::minmax(frames_, {}, &WeighedFrame::weight_n);
  const double ratio = std::log(heavy.weight_n / light.weight_n);
  if (ratio < std::log(kOtherWeight)) return first_exponent_;
  const auto typical = [&](double weight_n) {
    std::vector<double> residuals;
    for (std::size_t t = 0; t < frames_.size(); ++t) {
      if (frames_[t].weight_n == weight_n) residuals.push_back(residuals_[t]);
    }
    return median(residuals);
  };
  const double of_sums = ratio + typical(heavy.weight_n) - typical(light.weight_n);
  const double change = std::log(ratio / std::max(of_sums, 1e-3 * ratio));
  return first_exponent_ * std::exp(std::clamp(change, -kMostExponentChange, kMostExponentChange));
}

void WeightFit::fit(std::optional<Exponent> known) {
  constexpr int kSteps = 8;
  linearise();
  estimate_misfit();
  first_misfit_ = misfit_;
  response_.exponent = known ? known->value : start_exponent();
  known_ = Exponent{response_.exponent, 0};
  settle(2);
  known_ = known;
  settle(kSteps);
  for (int round = 0; round < 2; ++round) {
    estimate_spread();
    settle(2);
  }
  state_deviations();
}

WeightFit::Errors WeightFit::draw(std::span<const double> independent) const {
  const std::size_t count = x_.size();
  const std::vector<double> alone = posterior_->factor.spread(
      {independent.begin(), independent.begin() + static_cast<std::ptrdiff_t>(count)});
  Errors errors{std::vector<double>(count), 0, 0};
  errors.exponent = exponent_deviation_ * independent[count];
  const double slope = covariance_[0] > 0 ? covariance_[1] / covariance_[0] : 0;
  const double own = covariance_[2] - slope * covariance_[1];
  errors.log_counts_per_newton =
      slope * errors.exponent + std::sqrt(std::max(0.0, own)) * independent[count + 1];
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t at = place(i);
    errors.log_gains[i] = alone[at] - responses_[0][at] * errors.exponent -
                          responses_[1][at] * errors.log_counts_per_newton;
  }
  return errors;
}

}  // namespace pillarfield
