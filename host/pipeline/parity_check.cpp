#include "pipeline/parity_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

#include "pillarfield/calibration.h"
#include "pillarfield/error.h"
#include "pillarfield/reading_check.h"
#include "pillarfield/recording.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

using Check = ParityCheck;
using Pillars = std::vector<Check::Pillar>;
using Products = Check::Products;

constexpr double kInside = 4;     // distance from the ends of the range, deviations of a reading
constexpr double kClearly = 1.4;  // times what is stated
constexpr std::array<double, 4> kSigns = {1, -1, -1, 1};  // of V in the parity, row by row

/// Standard deviation of a reading, counts, if the plan states one, else zero.
double stated_noise_of(const SolverPlan& plan) {
  const bool is_stated = plan.noise_counts || !plan.calibration.noise.empty();
  return is_stated ? reading_noise_n(plan) * plan.skin.counts_per_newton : 0;
}

/// True if V is gain times the reading above its tare.
bool is_linear(const SolverPlan& plan) {
  const SensorEffects& effects = plan.calibration.effects;
  return !plan.skin.power_law && effects.curve.empty() && !effects.sensel_leak && !effects.wires &&
         !effects.memory && plan.calibration.bend_x.empty();
}

double parity_of(const std::array<float, 4>& v) {
  return double{v[0]} - double{v[1]} - double{v[2]} + double{v[3]};
}

float value_at(const std::vector<float>& plane, std::size_t sensel, float otherwise) {
  return plane.empty() ? otherwise : plane[sensel];
}

double samples_of(const Check::Pillar& pillar) { return pillar.products[1][1]; }
double changes_of(const Check::Pillar& pillar) { return pillar.changes; }
double change_squares_of(const Check::Pillar& pillar) { return pillar.change_squares; }
double parity_squares_of(const Check::Pillar& pillar) { return pillar.products[0][0]; }

template <class Value>
double sum_of(const Pillars& pillars, const Value& value) {
  return std::transform_reduce(pillars.begin(), pillars.end(), 0.0, std::plus<>(), value);
}

/// The pillars with samples, without outliers such as those of a stuck sensel: less than a
/// twentieth of them, beyond 7.4 medians of the root mean square. None if they are too few.
template <class Count, class Squares>
Pillars chosen(Pillars pillars, const Count& count, const Squares& squares) {
  std::erase_if(pillars, [&](const Check::Pillar& each) { return !(count(each) > 0); });
  const auto mean = [&](const Check::Pillar& each) { return squares(each) / count(each); };
  std::ranges::sort(pillars, {}, mean);
  std::size_t kept = pillars.size() - pillars.size() / 20;
  while (kept < pillars.size() && mean(pillars[kept]) < 55 * mean(pillars[kept / 2])) ++kept;
  pillars.resize(kept);
  return kept < 12 || sum_of(pillars, count) < 300 ? Pillars() : pillars;
}

/// The products of what the least-squares multiple of a term leaves.
Products without(const Products& products, std::size_t term) {
  Products left = products;
  for (std::size_t i = 0; i < left.size() && products[term][term] > 0; ++i) {
    const double slope = products[i][term] / products[term][term];
    for (std::size_t k = 0; k < left.size(); ++k) left[i][k] -= slope * products[term][k];
  }
  return left;
}

Products sum_of(const Pillars& pillars) {
  Products sum{};
  for (const Check::Pillar& each : pillars) {
    for (std::size_t i = 0; i < sum.size(); ++i) {
      for (std::size_t k = 0; k < sum.size(); ++k) sum[i][k] += each.products[i][k];
    }
  }
  return sum;
}

/// The multiple of a term that all pillars share.
struct Shared {
  double value = 0;
  double deviations = 0;  ///< from zero
};

/// By least squares beside another term. Deviations are those of whole pillars, whose errors last,
/// but not below those of noise, the variance of a parity.
Shared shared(const Pillars& pillars, std::size_t term, std::size_t beside, double noise) {
  const Products all = sum_of(pillars);
  const Products alone = without(all, beside);
  const double square = alone[term][term];
  if (!(square > 1e-9 * all[term][term])) return {};
  const double value = alone[0][term] / square;
  const double slope = all[term][beside] / all[beside][beside];
  const double other = (all[0][beside] - value * all[term][beside]) / all[beside][beside];
  const double variance = sum_of(pillars, [&](const Check::Pillar& each) {
    const auto rest = [&](std::size_t with) {
      const auto& row = each.products[with];
      return row[0] - value * row[term] - other * row[beside];
    };
    return std::pow(rest(term) - slope * rest(beside), 2);
  });
  return {value, std::abs(value) * square / std::sqrt(std::max(variance, noise * square))};
}

/// Judges the parity of loaded pillars.
class Judge {
 public:
  /// `noise` is the standard deviation of a reading, `stated` ResidualError::relative.
  Judge(Pillars pillars, double noise, double stated, Check::Found& found)
      : pillars_(std::move(pillars)),
        all_(sum_of(pillars_)),
        least_(kClearly * stated),
        found_(found) {
    constexpr double kFewChanges = 5;
    constexpr double kLeastExcess = 0.25;  // of the variance of noise
    noise_ = noise;
    samples_ = all_[Check::kTare][Check::kTare];
    noises_ = sum_of(pillars_, [&](const Check::Pillar& each) {
      const bool is_known = each.changes >= kFewChanges;
      const double own = is_known ? each.change_squares / (8 * each.changes) : 0;
      return 4 * samples_of(each) * std::max(noise * noise, own);
    });
    for (const auto term : {Check::kParity, Check::kSum, Check::kX, Check::kY}) {
      squares_ += all_[term][term] / 4;  // The four are orthogonal.
    }
    excess_ = all_[0][0] - noises_ - least_ * least_ * squares_;
    unshared_ = without(without(all_, Check::kCurve), Check::kLeak)[0][0];
    is_own_ = excess_ > kLeastExcess * noises_ && unshared_ - noises_ > 0.3 * excess_;
  }

  void run() {
    judge_shared();
    if (is_own_) judge_own();
  }

 private:
  /// Curve and leak, which all pillars share. Beside errors that each pillar has by itself, or
  /// noise, they are allowed for where they are possible, and named where sure.
  void judge_shared() {
    constexpr double kOfCurve = 1.3;  // relative errors of N: of a load far from the scale's own,
    constexpr double kOfLeak = 5;     // and with the leak within a pillar, which keeps parity
    Pillars own = pillars_;
    for (std::size_t term = 1; is_own_ && term < Check::kCurve; ++term) {
      for (Check::Pillar& each : own) each.products = without(each.products, term);
    }
    const Shared curve = shared(own, Check::kCurve, Check::kLeak, noises_ / samples_);
    const Shared leak = shared(own, Check::kLeak, Check::kCurve, noises_ / samples_);
    const bool has_others = is_own_ || found_.noise > 0;
    add(curve, kOfCurve * std::abs(curve.value), has_others,
        {fmt::format("Readings grow about as load^{:.2g}", 1 + curve.value),
         "'pillarfield calibrate equilibrate' at several pressures measures the curve."});
    add(leak, kOfLeak * leak.value, has_others,
        {fmt::format("Sensels read about {:.2g} % of their neighbours' load", 100 * leak.value),
         "'pillarfield calibrate leak' measures it."});
    if (found_.relative > 0 && found_.errors.empty() && !is_own_)
      contradict(all_[0][0] - unshared_);
  }

  void add(const Shared& each, double relative, bool has_others, Check::Error error) {
    constexpr double kLeast = 0.02;
    constexpr double kMost = 0.5;      // beyond it is another error
    constexpr double kPossible = 0.5;  // deviations from zero
    constexpr double kShown = 4;
    constexpr double kSure = 7;
    if (each.deviations < (has_others ? kPossible : kShown) || relative > kMost) return;
    if (relative < std::max(kLeast, least_)) return;
    found_.relative = std::hypot(found_.relative, relative);
    if (each.deviations > kSure) found_.errors.push_back(std::move(error));
  }

  void contradict(double squares) {
    found_.errors.push_back(
        {fmt::format("The readings of pillars contradict each other by about {:.2g} counts",
                     std::sqrt(squares / samples_) / 2),
         "'pillarfield doctor' looks for faults."});
  }

  /// Errors that each pillar has by itself. A cause is named if it leaves little of them, and the
  /// next one clearly more: loads that stay do not tell tares from gains.
  void judge_own() {
    constexpr double kMostLeft = 0.05;
    constexpr double kNoPattern = 0.8;
    constexpr double kNow = 1.3;  // a drift late in the recording, over its mean
    std::array<std::pair<double, std::size_t>, 3> left;
    for (std::size_t term = 1; term <= left.size(); ++term) {
      const double rest = sum_of(
          pillars_, [&](const Check::Pillar& each) { return without(each.products, term)[0][0]; });
      const double freedom = 1 - static_cast<double>(pillars_.size()) / samples_;
      left[term - 1] = {(rest / freedom - noises_) / excess_, term};
    }
    std::ranges::sort(left);
    const auto [least, best] = left[0];
    const bool is_named = least < kMostLeft && left[1].first > 2.5 * std::max(least, 0.0) + 0.02;
    const std::size_t cause = is_named ? best : Check::kParity;
    const double counts = std::sqrt(excess_ / samples_) / 2;
    const double gains = std::sqrt(excess_ / squares_);
    const bool is_noise = found_.noise > 0 && least > kNoPattern;  // of rows that hardly rested
    if (cause != Check::kSum) {
      found_.noise = std::hypot(noise_, cause == Check::kDrift ? kNow * counts : counts);
    }
    if (is_noise) return;
    if (cause != Check::kTare && cause != Check::kDrift) {
      found_.relative = std::hypot(found_.relative, gains);
    }
    if (cause == Check::kParity) return contradict(excess_);
    const std::array<Check::Error, 3> errors = {{
        {fmt::format("Tares are off by about {:.2g} counts", counts), "Take the tare again."},
        {fmt::format("Sensels drift by about {:.2g} counts", counts),
         "Let the tare follow with --follow-baseline (in Python baseline_time_s=)."},
        {fmt::format("Gains are off by about {:.2g} %", 100 * gains),
         "'pillarfield calibrate equilibrate' measures gains."},
    }};
    found_.errors.push_back(errors[cause - 1]);
  }

  Pillars pillars_;
  Products all_;
  double least_;  ///< relative error that is clearly more than stated
  Check::Found& found_;
  double noise_ = 0;
  double samples_ = 0;
  double noises_ = 0;    ///< sums over all samples, counts^2: variances of the parity by noise,
  double squares_ = 0;   ///< V^2,
  double excess_ = 0;    ///< parity^2 over noise and what is stated,
  double unshared_ = 0;  ///< and that which neither curve nor leak explains
  bool is_own_ = false;  ///< errors of single pillars are seen
};

/// Two digits, as messages have them: recordings of one sensor share their kernels.
double two_digits(double number) {
  const double unit = number > 0 ? std::pow(10, std::floor(std::log10(number)) - 1) : 1;
  return std::round(number / unit) * unit;
}

}  // namespace

ParityCheck::ParityCheck(const SolverPlan& plan)
    : plan_(plan),
      noise_(plan.skin.has_pillars() ? stated_noise_of(plan) : 0),
      judges_loads_(is_linear(plan)) {
  const auto least = static_cast<float>(kInside * noise_);
  usable_ = std::max(least, static_cast<float>(plan.skin.threshold_counts));
  most_ = static_cast<float>(plan.skin.full_scale_counts.value_or(1e30)) - least;
}

void ParityCheck::add(const FrameView& readings, bool follows) {
  if (!(noise_ > 0)) return;
  constexpr std::uint64_t kMostPillars = 2048;  // of a frame
  const Calibration& planes = plan_.calibration;
  const std::uint64_t pillars = plan_.skin.elements();
  const std::uint64_t step = (pillars + kMostPillars - 1) / kMostPillars;
  const bool is_first = pillars_.empty();
  pillars_.resize((pillars + step - 1) / step);
  ++frames_;
  const auto rate = static_cast<float>(plan_.baseline_rate.value_or(0));
  for (std::size_t i = 0; i < pillars_.size(); ++i) {
    Pillar& pillar = pillars_[i];
    const std::uint64_t row = 2 * (i * step / plan_.skin.pillar_cols());
    const std::uint64_t col = 2 * (i * step % plan_.skin.pillar_cols());
    std::array<float, 4> now{};
    std::array<float, 4> load{};
    bool is_whole = true;
    for (std::size_t k = 0; k < now.size(); ++k) {
      const std::uint64_t sensel = (row + k / 2) * readings.cols + col + k % 2;
      now[k] = raw_reading(readings, row + k / 2, col + k % 2);
      if (is_first) pillar.tare[k] = value_at(planes.tare, sensel, 0);
      load[k] = (now[k] - pillar.tare[k]) * value_at(planes.gain, sensel, 1);
      if (load[k] > usable_) load[k] += value_at(planes.dead_zone, sensel, 0);
      is_whole = is_whole && is_good(planes, sensel) && std::isfinite(now[k]) && now[k] < most_;
    }
    if (is_whole) {
      if (!is_first && follows) compare(now, pillar);
      if (judges_loads_ && std::ranges::min(load) > usable_) {
        add_load(readings, row, col, load, pillar);
      }
      for (std::size_t k = 0; k < now.size() && std::ranges::max(load) <= usable_; ++k) {
        pillar.tare[k] += rate * (now[k] - pillar.tare[k]);
      }
    }
    pillar.earlier = now;
  }
}

/// Adds the change of the parity of a pillar whose load stayed: its noise alone, since gains,
/// tares and loads cancel. The three other sums of the four changes, each with the noise of the
/// parity and independent of it, tell the load.
void ParityCheck::compare(const std::array<float, 4>& now, Pillar& pillar) const {
  constexpr double kSteady = 32;  // largest change of a sum, deviations of a reading
  std::array<float, 4> change{};
  for (std::size_t k = 0; k < now.size(); ++k) change[k] = now[k] - pillar.earlier[k];
  const auto [a, b, c, d] = change;
  const float moved =
      std::max({std::abs(a + b + c + d), std::abs(a + b - c - d), std::abs(a - b + c - d)});
  const double parity = parity_of(change);
  const float lowest = std::min(std::ranges::min(now), std::ranges::min(pillar.earlier));
  if (!std::isfinite(parity) || moved > kSteady * noise_ || lowest <= kInside * noise_) return;
  if (std::ranges::max(pillar.earlier) >= most_) return;
  pillar.change_squares += parity * parity;
  ++pillar.changes;
}

/// V of a sensel, counts: NaN if it is unknown, zero outside the frame.
float ParityCheck::load_of(const FrameView& readings, std::size_t row, std::size_t col) const {
  if (row >= readings.rows || col >= readings.cols) return 0;
  const Calibration& planes = plan_.calibration;
  const std::size_t sensel = row * readings.cols + col;
  const float now = raw_reading(readings, row, col);
  if (!is_good(planes, sensel) || !(now < most_)) return NAN;
  return (now - value_at(planes.tare, sensel, 0)) * value_at(planes.gain, sensel, 1);
}

/// Adds a pillar whose sensels are all usable. The terms: 1 of a tare, time of a drift, the sum of
/// V of gains; the parity of V ln V of a power, and that of the neighbours of each sensel in other
/// pillars of a leak.
void ParityCheck::add_load(const FrameView& readings, std::size_t row, std::size_t col,
                           const std::array<float, 4>& load, Pillar& pillar) {
  std::array<double, kTerms> terms = {parity_of(load), 1, frames_};
  for (std::size_t k = 0; k < load.size(); ++k) {
    const double v = load[k];
    const double even = std::max(v - kSigns[k] * terms[kParity] / 4, 1e-3);  // without parity
    const std::size_t r = row + k / 2;
    const std::size_t c = col + k % 2;
    const float beside = load_of(readings, k < 2 ? row - 1 : row + 2, c) +
                         load_of(readings, r, k % 2 == 0 ? col - 1 : col + 2);
    terms[kSum] += v;
    terms[kX] += k % 2 == 0 ? -v : v;
    terms[kY] += k < 2 ? v : -v;
    terms[kCurve] += kSigns[k] * even * std::log(even);
    terms[kLeak] += kSigns[k] * double{beside};
  }
  if (!std::isfinite(terms[kLeak])) return;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    for (std::size_t k = 0; k < terms.size(); ++k) pillar.products[i][k] += terms[i] * terms[k];
  }
}

ParityCheck::Found ParityCheck::found() const {
  Found found;
  const Pillars steady = chosen(pillars_, changes_of, change_squares_of);
  const double noise =
      std::sqrt(sum_of(steady, change_squares_of) / std::max(8 * sum_of(steady, changes_of), 1.0));
  if (noise > kClearly * noise_) {
    found.noise = noise;
    found.errors.push_back(
        {fmt::format("The readings' noise is about {:.2g} counts, and {:.3g} is stated",
                     without_rounding(noise), without_rounding(noise_)),
         "Give --noise (in Python noise_counts=), or take the tare again."});
  }
  Pillars loaded = chosen(pillars_, samples_of, parity_squares_of);
  const double stated = plan_.calibration.effects.residual.value_or(ResidualError{}).relative;
  if (!loaded.empty()) Judge(std::move(loaded), std::max(noise, noise_), stated, found).run();
  return found;
}

double ParityCheck::without_rounding(double noise) const {
  const double rounding = plan_.sensel_type == SenselType::f32 ? 0 : 1.0 / 12;
  return std::sqrt(std::max(noise * noise - rounding, 0.0));
}

std::vector<std::string> ParityCheck::Found::sentences(bool allowed_for) const {
  std::vector<std::string> sentences;
  for (const auto& [fault, mend] : errors) {
    sentences.push_back(fmt::format("{}, by the parity of pillars: deviations and intervals {}. {}",
                                    fault, allowed_for ? "allow for it" : "are too narrow", mend));
  }
  return sentences;
}

std::vector<std::string> allow_for_errors(SolverPlan& plan, FrameSource& source) {
  constexpr std::uint64_t kMostSensels = std::uint64_t{1} << 25U;
  constexpr std::uint64_t kMostFrames = 4096;  // behind a followed baseline: from the first on
  const std::uint64_t pairs =
      std::clamp<std::uint64_t>(kMostSensels / plan.skin.sensels(), 32, 128);
  ParityCheck check(plan);
  if (!(check.stated_noise() > 0)) return {};
  const bool all = plan.baseline_rate.has_value();
  const std::uint64_t frames = all ? std::min(source.frames(), kMostFrames) : source.frames();
  const std::uint64_t step = all ? 1 : std::max<std::uint64_t>(2, frames / pairs);
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  std::uint64_t next = 0;  // behind the last frame that was read
  for (std::uint64_t first = 0; first < frames; first += step) {
    for (std::uint64_t i = first; i < std::min({first + 2, first + step, frames}); ++i) {
      try {
        source.read(i, frame);
      } catch (const Error&) {
        continue;  // a damaged frame, which is reported where it is solved
      }
      check.add(frame.view(), i == next && (all || i > first));
      next = i + 1;
    }
  }
  const ParityCheck::Found found = check.found();
  if (found.noise > 0) {
    const double factor = found.noise / check.stated_noise();
    for (float& noise : plan.calibration.noise) noise *= static_cast<float>(factor);
    if (plan.noise_counts) plan.noise_counts = two_digits(check.without_rounding(found.noise));
  }
  if (found.relative > 0) {
    std::optional<ResidualError>& residual = plan.calibration.effects.residual;
    residual = residual.value_or(ResidualError{});
    residual->relative = std::min(two_digits(std::hypot(residual->relative, found.relative)), 1.0);
  }
  return found.sentences(true);
}

}  // namespace pillarfield
