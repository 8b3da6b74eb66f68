#include "pipeline/parity_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <set>

#include "pillarfield/calibration.h"
#include "pillarfield/error.h"
#include "pillarfield/reading_check.h"
#include "pillarfield/recording.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

constexpr std::uint64_t kMostPillars = 2048;  // of a frame
constexpr double kInside = 4;     // distance from the ends of the range, deviations of a reading
constexpr double kClearly = 1.4;  // times what is stated
constexpr double kLight = 64;     // least mean V^2 of a pillar, variances of a reading,
constexpr double kHeavy = 1000;   // and the one from which on it tells gains

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

double square_of(const std::array<float, 4>& v) {
  return std::inner_product(v.begin(), v.end(), v.begin(), 0.0);
}

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
      load[k] = (now[k] - tares_[i][k]) * value_at(planes.gain, sensel, 1);
      if (load[k] > usable) load[k] += value_at(planes.dead_zone, sensel, 0);
      is_whole = is_whole && is_good(planes, sensel) && now[k] < most;  // false for NaN
    }
    const auto [lowest, highest] = std::ranges::minmax(load);
    if (is_whole && !is_first && follows) compare(now, earlier_[i], i);
    if (is_whole && judges_loads_ && lowest > usable) {
      keep(loads_, {parity_of(load), square_of(load), double{lowest}, i});
    }
    for (std::size_t k = 0; k < now.size() && highest <= usable; ++k) {
      tares_[i][k] += rate * (now[k] - tares_[i][k]);
    }
    earlier_[i] = now;
  }
}

/// Keeps the change of the parity of a pillar whose load stayed: its noise alone, since gains,
/// tares and loads cancel. The three other sums of the four changes, each with the noise of the
/// parity and independent of it, tell the load.
void ParityCheck::compare(const std::array<float, 4>& now, const std::array<float, 4>& before,
                          std::size_t pillar) {
  constexpr double kSteady = 16;  // largest change of a sum, deviations of a reading
  std::array<float, 4> change{};
  for (std::size_t k = 0; k < now.size(); ++k) change[k] = now[k] - before[k];
  const auto [a, b, c, d] = change;
  const float moved =
      std::max({std::abs(a + b + c + d), std::abs(a + b - c - d), std::abs(a - b + c - d)});
  const double lowest = std::min(std::ranges::min(now), std::ranges::min(before));
  if (moved <= kSteady * noise_) keep(changes_, {parity_of(change), 0, lowest, pillar});
}

/// Keeps the last ones.
void ParityCheck::keep(std::vector<Sample>& samples, const Sample& sample) {
  constexpr std::size_t kMost = std::size_t{1} << 19U;
  if (samples.size() < kMost) return samples.push_back(sample);
  samples[seen_++ % kMost] = sample;
}

/// Means of parity^2 and of the sum of V^2 over the samples with a mean V^2 in [least, most),
/// variances of the noise, without outliers such as stuck sensels; zero if there are too few.
ParityCheck::Sample ParityCheck::mean_of(const std::vector<Sample>& samples, double noise,
                                         double least, double most) {
  constexpr std::size_t kFewSamples = 300;
  constexpr std::size_t kFewPillars = 12;
  constexpr double kOutlier = 7.4;  // medians of |parity|: 5 deviations
  std::vector<Sample> chosen;
  std::set<std::size_t> pillars;
  for (const Sample& sample : samples) {
    const double variances = sample.square / (4 * noise * noise);
    if (sample.lowest <= kInside * noise || variances < least || variances >= most) continue;
    chosen.push_back(sample);
    pillars.insert(sample.pillar);
  }
  if (chosen.size() < kFewSamples || pillars.size() < kFewPillars) return {};
  const auto middle = chosen.begin() + static_cast<std::ptrdiff_t>(chosen.size() / 2);
  std::ranges::nth_element(chosen, middle, {},
                           [](const Sample& at) { return std::abs(at.parity); });
  const double limit = std::max(kOutlier * std::abs(middle->parity), 10 * noise);
  Sample mean;
  double count = 0;
  for (const Sample& sample : chosen) {
    if (std::abs(sample.parity) > limit) continue;
    mean.parity += sample.parity * sample.parity;
    mean.square += sample.square;
    ++count;
  }
  mean.parity /= count;
  mean.square /= count;
  return mean;
}

ParityCheck::Found ParityCheck::found() const {
  constexpr double kLeastGainError = 0.015;
  const double steady = std::sqrt(mean_of(changes_, noise_, 0, HUGE_VAL).parity / 8);
  const double noise = std::max(steady, noise_);
  const Sample light = mean_of(loads_, noise, kLight, kHeavy);
  const Sample heavy = mean_of(loads_, noise, kHeavy, HUGE_VAL);
  const double none = light.square > 0 ? light.parity : 4 * noise * noise;
  const double rise = std::max(heavy.parity - none, 0.0);
  const double gains = rise > 0 ? rise / (heavy.square - light.square) : 0;
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
  const char* const end = allowed_for ? "allow for it" : "are too narrow";
  std::vector<std::string> sentences;
  if (found.noise > 0) {
    sentences.push_back(fmt::format(
        "The readings' noise{} is about {:.2g} counts, and {:.3g} is stated: deviations and "
        "intervals {}. Give --noise (in Python noise_counts=), or take the tare again.",
        found.is_drift ? ", with the drift or missing tare of single sensels," : "",
        without_rounding(found.noise), without_rounding(noise_), end));
  }
  if (found.gain_error > 0) {
    sentences.push_back(
        fmt::format("Gains are off by about {:.2g} %, by the parity of loaded pillars: deviations "
                    "and intervals {}. 'pillarfield calibrate equilibrate' measures gains.",
                    100 * found.gain_error, end));
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
