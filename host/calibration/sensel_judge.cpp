#include "calibration/sensel_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/quantile.h"

namespace pillarfield {
namespace {

/// Range of a constant reading, in its noise.
constexpr double kStill = 10;
/// Multiple of the typical noise above which a sensel is noisy.
constexpr double kNoisy = 5;
/// Distance from the typical level, in spreads, beyond which a level is an outlier.
constexpr double kFar = 6;
/// Least distance of a value that means nothing from the readings, in their range.
constexpr double kClear = 1;
/// Distance of the typical level from an end of the range, in the range, at which sensels rest
/// there.
constexpr double kNearEnd = 0.1;
/// Least share of sensels that must vary for a constant 0 to be odd, and for a constant reading at
/// the typical level to be stuck.
constexpr double kMostVary = 0.8;
/// Typical noise, counts, and frames from which a reading cannot be constant by chance, of a sensel
/// that has less than half of it.
constexpr double kVisibleNoise = 0.7;
constexpr std::uint32_t kVisibleFrames = 100;

}  // namespace

double least_noise(SenselType type) { return type == SenselType::f32 ? 0 : 1 / std::sqrt(12.0); }

std::vector<SenselEvidence> evidence_without_load(const FrameStatistics& unloaded) {
  std::vector<SenselEvidence> evidence;
  for (const SenselStatistics& read : unloaded.sensels()) {
    evidence.push_back({read, read.mean, std::max(read.deviation(), least_noise(unloaded.type()))});
  }
  return evidence;
}

std::optional<float> absent_value(std::span<const SenselEvidence> sensels) {
  std::map<float, std::size_t> constant;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const SenselEvidence& each : sensels) {
    if (each.read.readings == 0) continue;
    if (each.is_constant()) {
      ++constant[each.read.lowest];
    } else {
      lowest = std::min<double>(lowest, each.read.lowest);
      highest = std::max<double>(highest, each.read.highest);
    }
  }
  std::optional<float> found;
  std::size_t most = 0;
  for (const auto& [value, count] : constant) {
    const bool is_minus_one = value == -1 && lowest >= 0;
    const double clear = kClear * (highest - lowest);
    const bool is_clear = value < lowest - clear || value > highest + clear;
    if (!(is_minus_one || (count > 1 && value != 0 && is_clear)) || count <= most) continue;
    found = value;
    most = count;
  }
  return highest > lowest ? found : std::nullopt;
}

SenselJudge::SenselJudge(std::vector<SenselEvidence> sensels, std::uint32_t frames,
                         std::span<const std::uint8_t> mask)
    : sensels_(std::move(sensels)), frames_(frames), absent_(absent_value(sensels_)) {
  std::vector<double> levels;
  std::vector<double> varying_levels;
  std::vector<double> noises;
  std::size_t varying = 0;
  std::size_t present = 0;
  for (std::size_t i = 0; i < sensels_.size(); ++i) {
    const SenselEvidence& each = sensels_[i];
    const bool is_absent = each.is_constant() && absent_ && each.read.lowest == *absent_;
    present += is_absent || each.read.readings == 0 ? 0U : 1U;
    if (!each.is_constant()) {
      ++varying;
      lowest_ = std::min<double>(lowest_, each.read.lowest);
      highest_ = std::max<double>(highest_, each.read.highest);
    }
    const bool is_excluded = !mask.empty() && mask[i] != 1;
    if (is_excluded || is_absent || lacks_readings(each.read, frames_)) continue;
    if (is_saturated(each.read)) continue;
    if (!each.is_constant()) varying_levels.push_back(each.level);
    levels.push_back(each.level);
    noises.push_back(each.noise);
  }
  vary_share_ =
      static_cast<double>(varying) / static_cast<double>(std::max<std::size_t>(1, present));
  typical_.count = levels.size();
  if (levels.empty()) return;
  typical_.level = median(levels);
  typical_.noise = median(noises);
  typical_.low = varying_levels.empty() ? 0 : quantile(varying_levels, 0.02);
  for (double& level : levels) level = std::abs(level - typical_.level);
  // The median deviation of a normal distribution is 0.6745 of its standard deviation.
  typical_.spread = std::max(1.4826 * median(levels), typical_.noise);
}

bool lacks_readings(const SenselStatistics& read, std::uint32_t frames) {
  return 2 * std::uint64_t{read.readings} < frames || read.readings < 2;
}

bool is_saturated(const SenselStatistics& read) {
  return 2 * std::uint64_t{read.saturated} > read.readings;
}

bool SenselJudge::is_far_above(std::size_t sensel) const {
  return sensels_[sensel].level > typical_.level + kFar * typical_.spread;
}

std::optional<SenselFault> SenselJudge::verdict(std::size_t sensel) const {
  const SenselEvidence& each = sensels_[sensel];
  if (lacks_readings(each.read, frames_)) return SenselFault::not_a_number;
  if (is_saturated(each.read)) return SenselFault::saturated;
  if (each.is_constant()) return verdict_of_constant(sensel);
  const bool is_noisy = typical_.noise > 0 && each.noise > kNoisy * typical_.noise;
  return is_noisy ? std::optional(SenselFault::noisy) : std::nullopt;
}

std::optional<SenselFault> SenselJudge::verdict_of_constant(std::size_t sensel) const {
  const float value = sensels_[sensel].read.lowest;
  if (absent_ && value == *absent_) return SenselFault::absent;
  // At an end of the range near which the others rest, noise is cut off.
  const bool is_at_end = value >= highest_ || value <= lowest_;
  if (is_at_end && std::abs(value - typical_.level) < kNearEnd * (highest_ - lowest_)) {
    return std::nullopt;
  }
  const bool most_vary = vary_share_ >= kMostVary;
  if (value == 0) {
    const bool is_odd = most_vary && typical_.low > 4 * typical_.noise + 1;
    return is_odd ? std::optional(SenselFault::absent) : std::nullopt;
  }
  const bool is_far = std::abs(value - typical_.level) > kFar * typical_.spread;
  const bool shows_noise = typical_.noise > kVisibleNoise && frames_ >= kVisibleFrames;
  return is_far || (most_vary && shows_noise) ? std::optional(SenselFault::stuck) : std::nullopt;
}

bool is_still(const SenselStatistics& read, double noise) {
  return double{read.highest} - read.lowest <= kStill * noise;
}

}  // namespace pillarfield
