#include "pipeline/parity_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "pillarfield/calibration.h"
#include "pillarfield/reading_check.h"
#include "pillarfield/recording.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

constexpr std::uint64_t kMostPillars = 2048;  // of a frame
constexpr double kInside = 4;       // distance from the ends of the range, deviations of a reading
constexpr double kClearly = 1.4;    // times what is stated
constexpr double kMedian = 0.6745;  // of the magnitude, deviations
constexpr double kLight = 64;       // least mean V^2 of a pillar, variances of a reading,
constexpr double kHeavy = 1000;     // and the one from which on it tells gains

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

double squared(double value) { return value * value; }

double parity_of(const std::array<float, 4>& v) {
  return double{v[0]} - double{v[1]} - double{v[2]} + double{v[3]};
}

float value_at(const std::vector<float>& plane, std::size_t sensel, float otherwise) {
  return plane.empty() ? otherwise : plane[sensel];
}

}  // namespace

ParityCheck::ParityCheck(const SolverPlan& plan)
    : plan_(plan),
      noise_(plan.skin.has_pillars() ? stated_noise_of(plan) : 0),
      parity_unit_(plan.sensel_type == SenselType::f32 ? noise_ / 4 : 1),
      judges_loads_(is_linear(plan)) {}

void ParityCheck::add(const FrameView& readings, bool follows) {
  if (!(noise_ > 0)) return;
  const Calibration& planes = plan_.calibration;
  const std::uint64_t pillars = plan_.skin.elements();
  const std::uint64_t step = (pillars + kMostPillars - 1) / kMostPillars;
  const bool is_first = earlier_.empty();
  earlier_.resize((pillars + step - 1) / step);
  tares_.resize(earlier_.size());
  const auto least = static_cast<float>(kInside * noise_);
  const auto most = static_cast<float>(plan_.skin.full_scale_counts.value_or(1e30)) - least;
  const float usable = std::max(least, static_cast<float>(plan_.skin.threshold_counts));
  const auto rate = static_cast<float>(plan_.baseline_rate.value_or(0));
  for (std::size_t i = 0; i < earlier_.size(); ++i) {
    const std::uint64_t row = i * step / plan_.skin.pillar_cols();
    const std::uint64_t col = i * step % plan_.skin.pillar_cols();
    std::array<float, 4> now{};
    std::array<float, 4> load{};
    bool is_whole = true;
    for (std::size_t k = 0; k < now.size(); ++k) {
      const std::uint64_t at_row = 2 * row + k / 2;
      const std::uint64_t at_col = 2 * col + k % 2;
      const std::uint64_t sensel = at_row * readings.cols + at_col;
      now[k] = raw_reading(readings, at_row, at_col);
      if (is_first) tares_[i][k] = value_at(planes.tare, sensel, 0);
      load[k] = (now[k] - tares_[i][k]) * value_at(planes.gain, sensel, 1) +
                value_at(planes.dead_zone, sensel, 0);
      is_whole = is_whole && is_good(planes, sensel) && now[k] < most;  // false for NaN
    }
    const auto [lowest, highest] = std::ranges::minmax(load);
    if (is_whole && !is_first && follows) count_change(now, earlier_[i]);
    if (is_whole && judges_loads_ && lowest > usable) add_load(load, i);
    for (std::size_t k = 0; k < now.size() && highest <= usable; ++k) {
      tares_[i][k] += rate * (now[k] - tares_[i][k]);
    }
    earlier_[i] = now;
  }
}

/// Counts the change of the parity of a pillar whose load stayed: its noise alone, since gains,
/// tares and loads cancel. The three other sums of the four changes, each with the noise of the
/// parity and independent of it, tell the load.
void ParityCheck::count_change(const std::array<float, 4>& now,
                               const std::array<float, 4>& before) {
  constexpr double kSteady = 16;  // largest change of a sum, deviations of a reading
  std::array<float, 4> change{};
  for (std::size_t k = 0; k < now.size(); ++k) change[k] = now[k] - before[k];
  const auto [a, b, c, d] = change;
  const float moved =
      std::max({std::abs(a + b + c + d), std::abs(a + b - c - d), std::abs(a - b + c - d)});
  const float lowest = std::min(std::ranges::min(now), std::ranges::min(before));
  if (!(moved <= kSteady * noise_ && lowest > kInside * noise_)) return;  // NaN too
  const double units = std::abs(parity_of(change)) / parity_unit_;
  const auto last = static_cast<double>(changes_.size() - 1);
  ++changes_[static_cast<std::size_t>(std::round(std::min(units, last)))];
}

/// Keeps a pillar's parity; of many every other one, again and again.
void ParityCheck::add_load(const std::array<float, 4>& load, std::size_t pillar) {
  constexpr std::size_t kMostLoads = std::size_t{1} << 17U;
  if (loads_seen_++ % load_step_ != 0) return;
  double square = 0;
  for (const float v : load) square += double{v} * double{v};
  loads_.push_back({parity_of(load), square, double{std::ranges::min(load)}, pillar});
  if (loads_.size() < kMostLoads) return;
  for (std::size_t i = 0; i < kMostLoads / 2; ++i) loads_[i] = loads_[2 * i];
  loads_.resize(kMostLoads / 2);
  load_step_ *= 2;
}

/// Standard deviation of a reading by the median of the changes; zero if there are too few.
double ParityCheck::noise_of_changes() const {
  constexpr std::uint64_t kFewChanges = 500;
  std::uint64_t changes = 0;
  for (const std::uint64_t count : changes_) changes += count;
  if (changes < kFewChanges) return 0;
  double before = 0;
  std::size_t bin = 0;
  const double half = 0.5 * static_cast<double>(changes);
  while (before + static_cast<double>(changes_[bin]) < half) {
    before += static_cast<double>(changes_[bin++]);
  }
  const double low = bin == 0 ? 0 : static_cast<double>(bin) - 0.5;
  const double high = static_cast<double>(bin) + 0.5;
  const double median = low + (high - low) * (half - before) / static_cast<double>(changes_[bin]);
  return median * parity_unit_ / (kMedian * std::sqrt(8.0));
}

/// Means of parity^2 and of the sum of V^2 over the pillars with a mean V^2 in (least, most],
/// variances of the noise, without outliers such as stuck sensels; zero if there are too few.
ParityCheck::Load ParityCheck::mean_of(double noise, double least, double most) const {
  constexpr std::size_t kFewLoads = 300;
  constexpr std::size_t kFewPillars = 12;
  constexpr double kOutlier = 5;  // deviations
  std::vector<Load> loads;
  for (const Load& load : loads_) {
    const double variances = load.square / (4 * noise * noise);
    if (load.lowest > kInside * noise && variances > least && variances <= most) {
      loads.push_back(load);
    }
  }
  std::set<std::size_t> pillars;
  for (const Load& load : loads) pillars.insert(load.pillar);
  if (loads.size() < kFewLoads || pillars.size() < kFewPillars) return {};
  const auto middle = loads.begin() + static_cast<std::ptrdiff_t>(loads.size() / 2);
  std::ranges::nth_element(loads, middle, {}, [](const Load& at) { return std::abs(at.parity); });
  const double limit = kOutlier * std::max(std::abs(middle->parity) / kMedian, 2 * noise);
  Load sum;
  double count = 0;
  for (const Load& load : loads) {
    if (std::abs(load.parity) > limit) continue;
    sum.parity += load.parity * load.parity;
    sum.square += load.square;
    ++count;
  }
  return {sum.parity / count, sum.square / count, 0, pillars.size()};
}

ParityCheck::Found ParityCheck::found() const {
  constexpr double kLeastGainError = 0.015;
  constexpr double kSurely = 1;  // deviation
  const double steady = noise_of_changes();
  const double noise = std::max(steady, noise_);
  const Load light = mean_of(noise, kLight, kHeavy);
  const Load heavy = mean_of(noise, kHeavy, HUGE_VAL);
  const bool is_split = light.square > 0;
  const double none = is_split ? light.parity : 4 * noise * noise;
  const double rise = heavy.parity - none;
  // Drift and gains stay from frame to frame: each pillar is one sample.
  const double variance = 2 * (squared(heavy.parity) / static_cast<double>(heavy.pillar) +
                               (is_split ? squared(none) / static_cast<double>(light.pillar) : 0));
  const bool rises = heavy.square > 0 && rise > kSurely * std::sqrt(variance);
  const double gains = rises ? rise / (heavy.square - light.square) : 0;
  const double loaded = std::sqrt(std::max(light.parity - gains * light.square, 0.0)) / 2;
  Found found;
  found.noise = std::max(steady, loaded);
  found.is_drift = !(steady > kClearly * noise_);
  if (!(found.noise > kClearly * noise_)) found.noise = 0;
  found.gain_error = std::sqrt(gains);
  const double stated = plan_.calibration.effects.residual.value_or(ResidualError{}).relative;
  if (!(found.gain_error > std::max(kLeastGainError, kClearly * stated))) found.gain_error = 0;
  return found;
}

double ParityCheck::without_rounding(double noise) const {
  const double rounding = plan_.sensel_type == SenselType::f32 ? 0 : 1.0 / 12;
  return std::sqrt(std::max(noise * noise - rounding, 0.0));
}

std::vector<std::string> ParityCheck::warnings(bool allowed_for) const {
  const Found found = this->found();
  std::vector<std::string> sentences;
  if (found.noise > 0) {
    const double noise = without_rounding(found.noise);
    sentences.push_back(fmt::format(
        "The readings' noise{} is about {:.2g} counts, and {:.3g} is stated: {}",
        found.is_drift ? " with the drift of single sensels under load" : "", noise,
        without_rounding(noise_),
        allowed_for
            ? fmt::format("deviations and intervals are for {:.2g}.", noise)
            : fmt::format("deviations and intervals are too narrow. Give --noise {:.2g} (in "
                          "Python noise_counts=), or take the tare again.",
                          noise)));
  }
  if (found.gain_error > 0) {
    sentences.push_back(
        fmt::format("Gains are off by about {:.2g} %, by the parity of loaded pillars: deviations "
                    "and intervals "
                    "{}. 'pillarfield calibrate equilibrate' measures them.",
                    100 * found.gain_error, allowed_for ? "allow for it" : "are too narrow"));
  }
  return sentences;
}

std::vector<std::string> allow_for_errors(SolverPlan& plan, FrameSource& source) {
  constexpr std::uint64_t kMostSensels = std::uint64_t{1} << 25U;
  constexpr std::uint64_t kMostFrames = 4096;  // behind a followed baseline: from the first on
  const std::uint64_t pairs =
      std::clamp<std::uint64_t>(kMostSensels / plan.skin.sensels(), 64, 1024);
  ParityCheck check(plan);
  if (!(check.stated_noise() > 0)) return {};
  const bool all = plan.baseline_rate.has_value();
  const std::uint64_t frames = all ? std::min(source.frames(), kMostFrames) : source.frames();
  const std::uint64_t step = all ? 1 : std::max<std::uint64_t>(2, frames / pairs);
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  for (std::uint64_t first = 0; first < frames; first += step) {
    for (std::uint64_t i = first; i < std::min({first + 2, first + step, frames}); ++i) {
      source.read(i, frame);
      check.add(frame.view(), all || i > first);
    }
  }
  std::vector<std::string> sentences = check.warnings(true);
  const ParityCheck::Found found = check.found();
  if (found.noise > 0) {
    const double factor = found.noise / check.stated_noise();
    for (float& noise : plan.calibration.noise) noise *= static_cast<float>(factor);
    if (plan.noise_counts) plan.noise_counts = check.without_rounding(found.noise);
  }
  if (found.gain_error > 0) {
    std::optional<ResidualError>& residual = plan.calibration.effects.residual;
    residual = residual.value_or(ResidualError{});
    residual->relative = found.gain_error;
  }
  return sentences;
}

}  // namespace pillarfield
