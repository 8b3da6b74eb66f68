#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"
#include "calibration/neighbours.h"

namespace pillarfield {
namespace {

/// Least noise of nearly all varying sensels from which a constant reading is no chance, counts,
/// and the frames that takes.
constexpr double kTellingNoise = 0.35;
constexpr double kNearlyAllNoise = 0.02;
constexpr std::uint64_t kTellingFrames = 50;
/// Largest share of constant sensels that stand out.
constexpr double kFewConstant = 0.1;
/// Distance from the usual level from which a level is another, in deviations of levels.
constexpr double kOutOfPlace = 6;
/// Multiple of the usual noise from which a sensel is noisy, and deviations of its logarithm.
constexpr double kNoisier = 7;
constexpr double kNoiseSpread = 5;
constexpr std::size_t kCalmFrames = 20;
/// Distance of a value that stands for "no sensel" from all others, in their range.
constexpr float kClearOf = 0.5F;

/// Median and deviation by quantiles; the deviation is at least `least`.
struct UsualValue {
  double middle = 0;
  double deviation = 0;

  UsualValue(std::vector<double> values, double least) : deviation(least) {
    if (values.empty()) return;
    middle = median(values);
    for (double& value : values) value = std::abs(value - middle);
    deviation = std::max(least, 1.4826 * median(values));
  }
};

class OddSensels {
 public:
  explicit OddSensels(Examination& seen) : seen_(seen) {
    for (std::size_t i = 0; i < seen.read.size(); ++i) {
      if (seen.read[i].readings == 0) continue;
      if (seen.constant[i] != 0) {
        ++constant_[seen.read[i].lowest];
        continue;
      }
      levels_.push_back(seen.idle[i]);
      ++ends_[seen.read[i].lowest];
      ++ends_[seen.read[i].highest];
      logs_.push_back(log_jitter(i));
      noises_.push_back(seen_.noise[i]);
      lowest_ = std::min(lowest_, seen.read[i].lowest);
      highest_ = std::max(highest_, seen.read[i].highest);
    }
  }

  void judge() {
    seen_.verdicts.resize(seen_.read.size());
    if (logs_.empty()) return;
    judge_absent();
    std::size_t constant = 0;
    for (std::size_t i = 0; i < seen_.read.size(); ++i) constant += is_open(i) ? 1U : 0U;
    const bool tells = quantile(noises_, kNearlyAllNoise) > kTellingNoise &&
                       seen_.statistics.frames() >= kTellingFrames;
    const double few = kFewConstant * static_cast<double>(seen_.read.size());
    if (tells && static_cast<double>(constant) <= std::max(1.0, few)) judge_constant();
    judge_noise();
  }

 private:
  /// Logarithm of the noise from frame to frame, at least that of rounding.
  [[nodiscard]] double log_jitter(std::size_t i) const {
    const bool is_whole = seen_.statistics.type() != SenselType::f32;
    return std::log(std::max<double>(seen_.jitter[i], is_whole ? 0.5 : 1e-9));
  }

  /// True of a constant sensel that has no verdict.
  [[nodiscard]] bool is_open(std::size_t i) const {
    return seen_.constant[i] != 0 && !seen_.verdicts[i];
  }

  /// No reading at all, or a value that is none: -1, or far from all others.
  void judge_absent() {
    const float clear = kClearOf * (highest_ - lowest_);
    for (std::size_t i = 0; i < seen_.read.size(); ++i) {
      if (seen_.read[i].readings == 0) {
        seen_.verdicts[i] = SenselFault::not_a_number;
      } else if (seen_.constant[i] != 0) {
        const float value = seen_.read[i].lowest;
        const bool is_clear = value < lowest_ - clear || value > highest_ + clear;
        const bool is_none = value == -1 || constant_[value] > 1;
        const bool can_be_rest = value == 0 || value >= static_cast<float>(seen_.full_scale);
        if (is_none && !can_be_rest && (is_clear || (value == -1 && lowest_ >= 0))) {
          seen_.verdicts[i] = SenselFault::absent;
        }
      }
    }
  }

  /// Constant, although it would show noise as all others do. At an end of the range it may rest
  /// beyond it, or be pressed.
  void judge_constant() {
    const UsualValue level(levels_, 1);
    const auto is_far = [&](float reading) {
      return std::abs(reading - level.middle) > kOutOfPlace * level.deviation;
    };
    for (std::size_t i = 0; i < seen_.read.size(); ++i) {
      if (!is_open(i) || is_in_constant_line(i)) continue;
      const float value = seen_.read[i].lowest;
      if (value > lowest_ && value < highest_) {
        seen_.verdicts[i] = SenselFault::stuck;
        continue;
      }
      // Nothing may press the sensels around it for good.
      const Neighbours around(seen_.statistics.skin(), i);
      const bool is_alone = std::ranges::none_of(around.all(), [&](std::size_t n) {
        return seen_.constant[n] == 0 && is_far(seen_.idle[n]);
      });
      if (is_far(value) && is_alone) {
        seen_.verdicts[i] = value == 0                                     ? SenselFault::absent
                            : value < static_cast<float>(seen_.full_scale) ? SenselFault::stuck
                                                                           : SenselFault::saturated;
      }
    }
  }

  /// True if all of a row or column is constant: touches beside it show whether it is dead.
  [[nodiscard]] bool is_in_constant_line(std::size_t i) const {
    const auto [row, col] = seen_.place(i);
    bool is_row = true;
    bool is_column = true;
    for (std::size_t n = 0; n < seen_.cols; ++n) {
      is_row = is_row && seen_.constant[seen_.sensel(LineAxis::rows, row, n)] != 0;
    }
    for (std::size_t n = 0; n < seen_.rows; ++n) {
      is_column = is_column && seen_.constant[seen_.sensel(LineAxis::columns, col, n)] != 0;
    }
    return is_row || is_column;
  }

  /// Far noisier than the others at rest: load trembles, too, and an end of the range cuts noise.
  void judge_noise() {
    const UsualValue log(logs_, 0.1);
    const UsualValue level(levels_, seen_.typical_noise);
    const double least = log.middle + std::max(std::log(kNoisier), kNoiseSpread * log.deviation);
    for (std::size_t i = 0; i < seen_.read.size(); ++i) {
      if (seen_.constant[i] != 0 || log_jitter(i) < least) continue;
      const bool is_cut = is_shared_end(seen_.read[i].lowest, lowest_) ||
                          is_shared_end(seen_.read[i].highest, highest_);
      const double beyond = std::abs(seen_.idle[i] - level.middle);
      if (is_cut || trembles_around(i, log.middle) ||
          beyond > 3 * std::max<double>(level.deviation, seen_.jitter[i] / 3))
        continue;
      if (std::log(noise_at_rest(i)) > least) seen_.verdicts[i] = SenselFault::noisy;
    }
  }

  /// True if a load that trembles may cover this sensel and one around it.
  [[nodiscard]] bool trembles_around(std::size_t i, double usual_log) const {
    const Neighbours around(seen_.statistics.skin(), i);
    return std::ranges::any_of(around.all(), [&](std::size_t n) {
      return seen_.constant[n] == 0 && log_jitter(n) > usual_log + std::log(kNoisier);
    });
  }

  /// True if a sensel's extreme is that of the array, and of another sensel.
  [[nodiscard]] bool is_shared_end(float extreme, float end) const {
    return extreme == end && ends_.at(extreme) > 1;
  }

  /// Deviation from frame to frame while nothing loads the sensels around, and half of the
  /// readings are about rest; 0: not shown.
  [[nodiscard]] double noise_at_rest(std::size_t i) const {
    const Neighbours around(seen_.statistics.skin(), i);
    std::vector<double> changes;
    std::vector<double> signals;
    const auto is_calm = [&](std::size_t frame) {
      return std::ranges::none_of(around.all(), [&](std::size_t n) {
        return std::as_const(seen_.kept).frame(frame)[n] > seen_.threshold(n);
      });
    };
    for (std::size_t frame = 1; frame < seen_.kept.frames(); ++frame) {
      if (!is_calm(frame) || !is_calm(frame - 1)) continue;
      signals.push_back(std::as_const(seen_.kept).frame(frame)[i]);
      changes.push_back(std::abs(signals.back() - std::as_const(seen_.kept).frame(frame - 1)[i]));
    }
    if (changes.size() < kCalmFrames) return 0;
    const double noise = median(changes) / (0.6745 * std::sqrt(2.0));
    return std::abs(median(signals)) < 2 * noise ? noise : 0;
  }

  Examination& seen_;
  std::map<float, std::size_t> constant_;  ///< number of sensels that read it always
  std::map<float, std::size_t> ends_;      ///< number of sensels whose extreme it is
  std::vector<double> levels_;             ///< of sensels that vary
  std::vector<double> logs_;               ///< of their noise from frame to frame
  std::vector<double> noises_;
  float lowest_ = std::numeric_limits<float>::infinity();
  float highest_ = -std::numeric_limits<float>::infinity();
};

}  // namespace

void find_odd_sensels(Examination& seen, Diagnosis& found) {
  OddSensels(seen).judge();
  for (const auto& [fault, verdicts] :
       {std::pair(ArrayFault::absent, std::set{SenselFault::absent, SenselFault::not_a_number}),
        std::pair(ArrayFault::stuck, std::set{SenselFault::stuck}),
        std::pair(ArrayFault::saturated, std::set{SenselFault::saturated}),
        std::pair(ArrayFault::noisy, std::set{SenselFault::noisy})}) {
    ArrayFinding finding = {.fault = fault};
    std::vector<double> means;
    std::vector<double> noises;
    for (std::size_t i = 0; i < seen.verdicts.size(); ++i) {
      if (!seen.verdicts[i] || !verdicts.contains(*seen.verdicts[i])) continue;
      finding.sensels.push_back(seen.place(i));
      means.push_back(seen.read[i].mean);
      noises.push_back(seen.noise[i] / seen.typical_noise);
    }
    if (finding.sensels.empty()) continue;
    finding.figure = fault == ArrayFault::noisy ? median(noises) : median(means);
    add(found, std::move(finding));
  }
  for (std::size_t i = 0; i < seen.verdicts.size(); ++i) seen.good[i] = seen.verdicts[i] ? 0 : 1;
}

}  // namespace pillarfield
