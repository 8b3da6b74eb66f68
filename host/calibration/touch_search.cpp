#include "calibration/touch_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/quantile.h"
#include "calibration/neighbours.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

/// Sum of a patch of 3 x 3 sensels, in its standard deviations, from which it is a touch.
constexpr double kTouchDeviations = 6.5;
/// That of the sum without the largest, and of the sum of counts, which errors of noise leave
/// alone.
constexpr double kRestDeviations = 4;
constexpr double kCountDeviations = 5;
/// Least mean distance in the patch, in noises.
constexpr double kLeastMean = 1;
/// Distance of a sensel that takes part in it, in noises.
constexpr double kPartDeviations = 2;
constexpr int kLeastParts = 4;
/// Distance of a reading from its level, in noises, that is a spike or of a touch of one sensel.
constexpr double kSpikeDeviations = 8;
/// Frames that a spike lasts; of twenty frames of a sensel at most one, on average, has a spike.
constexpr std::size_t kSpikeFrames = 2;
constexpr std::size_t kSpikeEach = 20;
/// Factor on the usual change within some frames from which one is sudden.
constexpr double kSudden = 6;
/// Least noise, in steps of the converter: that of rounding, and of flicker between two values.
constexpr double kLeastNoise = 0.4;
/// Noise of neighbours, relative to the typical one, that is not taken for noise.
constexpr double kMostNoise = 3;
/// Frames that noise is measured in.
constexpr std::size_t kWindow = 5;
/// The median variance of five normal readings.
constexpr double kMedianVariance = 0.839;
/// The median distance of a normal distribution, in standard deviations.
constexpr double kMedianDistance = 0.6745;
/// Nine of ten are nearer.
constexpr double kNinthDistance = 1.645;
/// Sensels of which medians of a frame are taken.
constexpr std::size_t kSampled = 4096;

/// Median variance of windows of successive readings.
double window_variance(std::span<const float> series) {
  std::vector<double> variances;
  for (std::size_t t = 0; t + kWindow <= series.size(); t += 2) {
    double mean = 0;
    double squares = 0;
    for (const float each : series.subspan(t, kWindow)) mean += each / double{kWindow};
    for (const float each : series.subspan(t, kWindow)) squares += (each - mean) * (each - mean);
    variances.push_back(squares / (kWindow - 1));
  }
  return variances.empty() ? 0 : median(variances) / kMedianVariance;
}

/// Level of a sensel, or of the whole array: level + slope (t − middle), with noise.
struct SteadyLevel {
  double level = 0;
  double slope = 0;  ///< counts a frame
  double noise = 0;

  explicit SteadyLevel(std::span<const float> series);
  SteadyLevel() = default;
  [[nodiscard]] double at(double frames_from_middle) const {
    return level + slope * frames_from_middle;
  }
};

SteadyLevel::SteadyLevel(std::span<const float> series) {
  const std::size_t count = series.size();
  noise = std::sqrt(window_variance(series));
  const std::size_t lag = std::max<std::size_t>(1, count / 4);
  std::vector<double> rises;
  for (std::size_t t = 0; t + lag < count; ++t) rises.push_back(series[t + lag] - series[t]);
  if (rises.empty()) return;
  const double rise = median(rises);
  // The deviation of the median is about twice the noise, by the root of the frames.
  if (std::abs(rise) > 8 * noise / std::sqrt(static_cast<double>(count))) {
    slope = rise / static_cast<double>(lag);
  }
  std::vector<double> levels;
  const double middle = 0.5 * static_cast<double>(count - 1);
  for (std::size_t t = 0; t < count; ++t) {
    levels.push_back(series[t] - slope * (static_cast<double>(t) - middle));
  }
  level = median(levels);
}

class TouchSearch {
 public:
  TouchSearch(const TareFrames& frames, std::span<const std::uint8_t> mask);
  ExaminedFrames run();

 private:
  struct Spike {
    std::uint32_t frame;
    std::uint32_t sensel;
    auto operator<=>(const Spike&) const = default;
  };

  void find_levels(std::span<const std::uint8_t> mask);
  void limit_noise(double most);
  void find_common_changes();
  void search_array();
  void search_trends();
  void search_sensel(std::size_t i);
  void search_windows(ExaminedFrames& examined);
  /// Looks for a touch in the sums of distances from levels, in noises, over the root of their
  /// number.
  void search_map(std::span<const float> map, std::size_t first, std::size_t last, double root = 1);
  [[nodiscard]] double spread(std::span<const float> map) const;
  [[nodiscard]] bool is_coherent(std::span<const float> map, std::size_t i, double sign,
                                 double scale, double scale_counts) const;
  /// Distance of a reading from its level, counts; 0 of one that is missing.
  [[nodiscard]] double distance(std::size_t frame, std::size_t i) const {
    const float reading = frames_.readings(frame)[i];
    if (!(std::abs(reading) <= kMaxCounts)) return 0;
    return reading - levels_[i].at(static_cast<double>(frame) - middle_) - common_[frame];
  }
  void note(const MovingTouch& found, double deviations);

  const TareFrames& frames_;
  const std::size_t count_;  ///< of kept frames
  const std::size_t cols_;
  const double middle_;
  std::vector<SteadyLevel> levels_;
  std::vector<std::uint8_t> used_;
  std::vector<std::uint32_t> sampled_;  ///< used sensels with a used one to the right
  std::vector<float> common_;           ///< of each frame, counts
  std::vector<float> spreads_;          ///< of each frame, in noises
  std::vector<Spike> spikes_;
  std::optional<MovingTouch> touch_;
  double most_ = 0;
};

TouchSearch::TouchSearch(const TareFrames& frames, std::span<const std::uint8_t> mask)
    : frames_(frames),
      count_(frames.kept()),
      cols_(frames.skin().cols),
      middle_(0.5 * static_cast<double>(count_ - 1)),
      levels_(frames.skin().sensels()),
      used_(levels_.size()),
      common_(count_),
      spreads_(count_, 1) {
  find_levels(mask);
}

void TouchSearch::find_levels(std::span<const std::uint8_t> mask) {
  double step = std::numeric_limits<double>::infinity();  // of converter or rounding
  std::vector<double> noises;
  std::vector<float> series;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    if (!mask.empty() && mask[i] != 1) continue;
    series.clear();
    std::size_t lacking = 0;
    for (std::size_t t = 0; t < count_; ++t) {
      const float reading = frames_.readings(t)[i];
      const bool is_there = std::abs(reading) <= kMaxCounts;
      lacking += is_there ? 0 : 1;
      if (is_there || !series.empty()) series.push_back(is_there ? reading : series.back());
    }
    if (2 * lacking > count_) continue;
    for (std::size_t t = 1; t < series.size(); ++t) {
      const double change = std::abs(series[t] - series[t - 1]);
      if (change > 0) step = std::min(step, change);
    }
    levels_[i] = SteadyLevel(series);
    const auto [low, high] = std::ranges::minmax(series);
    used_[i] = high > low ? 1 : 0;
    if (used_[i] != 0) noises.push_back(levels_[i].noise);
  }
  if (noises.empty()) return;
  const double typical = median(noises);
  const double least = std::max(kLeastNoise * step, 0.2 * typical);
  for (SteadyLevel& each : levels_) each.noise = std::max(each.noise, least);
  limit_noise(std::max(least, kMostNoise * typical));
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    if (used_[i] != 0) sampled_.push_back(static_cast<std::uint32_t>(i));
  }
  const std::size_t each = 1 + sampled_.size() / kSampled;
  for (std::size_t n = 0; n * each < sampled_.size(); ++n) sampled_[n] = sampled_[n * each];
  sampled_.resize((sampled_.size() + each - 1) / each);
}

/// A touch that comes and goes in a few frames looks like noise, but of neighbours together.
void TouchSearch::limit_noise(double most) {
  std::vector<std::uint8_t> noisy(levels_.size());
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    noisy[i] = used_[i] != 0 && levels_[i].noise > most ? 1 : 0;
  }
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    const Neighbours around(frames_.skin(), i);
    const auto all = around.all();
    const auto count = std::ranges::count_if(all, [&](std::size_t n) { return noisy[n] != 0; });
    if (noisy[i] != 0 && 3 * count >= std::ssize(all)) levels_[i].noise = most;
  }
}

void TouchSearch::note(const MovingTouch& found, double deviations) {
  if (!touch_) touch_ = found;
  const std::size_t first = std::min(touch_->first, found.first);
  const std::size_t last = std::max(touch_->last, found.last);
  if (deviations > most_) touch_ = found;
  most_ = std::max(most_, deviations);
  touch_->first = first;
  touch_->last = last;
}

/// The mean of the middle half of the distances from the levels.
void TouchSearch::find_common_changes() {
  std::vector<double> changes(sampled_.size());
  for (std::size_t t = 0; t < count_; ++t) {
    for (std::size_t n = 0; n < changes.size(); ++n) changes[n] = distance(t, sampled_[n]);
    const double low = quantile(changes, 0.25);
    const double high = quantile(changes, 0.75);
    double sum = 0;
    double count = 0;
    for (const double each : changes) {
      if (each < low || each > high) continue;
      sum += each;
      ++count;
    }
    common_[t] = static_cast<float>(sum / count);
  }
}

/// Drift of the array is slow and hum comes and goes; a load on all sensels comes at once and
/// stays.
void TouchSearch::search_array() {
  std::vector<double> noises;
  for (const auto i : sampled_) noises.push_back(levels_[i].noise);
  const SteadyLevel whole(common_);
  const double limit = std::max(kSpikeDeviations * whole.noise, 6 * median(noises));
  const auto change = [&](std::size_t t) {
    return common_[t] - whole.at(static_cast<double>(t) - middle_);
  };
  const std::size_t near = std::max<std::size_t>(3, count_ / 30);
  std::vector<double> usual;
  for (std::size_t t = 0; t + 2 * near < count_; ++t) {
    usual.push_back(std::abs(change(t + 2 * near) - change(t)));
  }
  const double slow = kSudden * quantile(usual, 0.75);
  for (std::size_t t = 0; t < count_; ++t) {
    std::size_t end = t;
    while (end < count_ && std::abs(change(end)) > limit) ++end;
    if (end - t > kSpikeFrames) {
      double jump = 0;
      for (const std::size_t at : {t, end}) {
        const std::size_t from = at < near ? 0 : at - near;
        const std::size_t to = std::min(count_ - 1, at + near);
        jump = std::max(jump, std::abs(change(to) - change(from)));
      }
      const double most = std::abs(change((t + end) / 2));
      if (jump > std::max(most / 2, slow))
        note({0, true, change((t + end) / 2), t, end - 1}, most / median(noises));
    }
    t = end;
  }
}

/// Spread of the differences of neighbours.
double TouchSearch::spread(std::span<const float> map) const {
  std::vector<double> differences;
  for (const std::size_t i : sampled_) {
    if ((i + 1) % cols_ != 0 && used_[i + 1] != 0) {
      differences.push_back(std::abs(map[i + 1] - map[i]) / std::sqrt(2));
    } else if (i + cols_ < used_.size() && used_[i + cols_] != 0) {
      differences.push_back(std::abs(map[i + cols_] - map[i]) / std::sqrt(2));
    }
  }
  if (differences.empty()) return 1;
  return std::max(median(differences) / kMedianDistance,
                  quantile(differences, 0.9) / kNinthDistance);
}

/// True if several sensels of the patch about `i`, not all of one line, leave their level one way,
/// in noises and in counts, and not one of them alone.
bool TouchSearch::is_coherent(std::span<const float> map, std::size_t i, double sign, double scale,
                              double scale_counts) const {
  double sum = 0;
  double most = 0;
  double counts = 0;
  int present = 0;
  std::vector<std::size_t> parts;
  const auto add = [&](std::size_t at) {
    if (used_[at] == 0) return;
    const double value = sign * map[at];
    ++present;
    sum += value;
    most = std::max(most, value);
    counts += value * levels_[at].noise;
    if (value >= kPartDeviations * scale) parts.push_back(at);
  };
  add(i);
  const Neighbours around(frames_.skin(), i);
  std::ranges::for_each(around.all(), add);
  if (std::ssize(parts) < std::clamp(present - 1, 3, kLeastParts)) return false;
  const bool in_row =
      std::ranges::all_of(parts, [&](auto at) { return at / cols_ == parts[0] / cols_; });
  const bool in_col =
      std::ranges::all_of(parts, [&](auto at) { return at % cols_ == parts[0] % cols_; });
  return !in_row && !in_col && sum - most > kRestDeviations * scale * std::sqrt(present - 1) &&
         counts > kCountDeviations * scale_counts * std::sqrt(present);
}

void TouchSearch::search_map(std::span<const float> map, std::size_t first, std::size_t last,
                             double root) {
  const double scale = std::max(1.0, spread(map));
  double scale_counts = 0;
  std::vector<float> across(map.size());
  std::vector<float> number(map.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const bool left = i % cols_ != 0;
    const bool right = (i + 1) % cols_ != 0;
    across[i] = map[i] + (left ? map[i - 1] : 0) + (right ? map[i + 1] : 0);
    number[i] =
        static_cast<float>(used_[i] + (left ? used_[i - 1] : 0) + (right ? used_[i + 1] : 0));
  }
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (used_[i] == 0) continue;
    float sum = across[i];
    float count = number[i];
    if (i >= cols_) {
      sum += across[i - cols_];
      count += number[i - cols_];
    }
    if (i + cols_ < map.size()) {
      sum += across[i + cols_];
      count += number[i + cols_];
    }
    const double deviations = std::abs(sum) / (scale * std::sqrt(count));
    if (deviations < kTouchDeviations || std::abs(sum) < kLeastMean * count * root) continue;
    if (scale_counts == 0) {
      std::vector<float> counts(map.begin(), map.end());
      for (std::size_t n = 0; n < counts.size(); ++n) {
        counts[n] *= static_cast<float>(levels_[n].noise);
      }
      scale_counts = spread(counts);
    }
    if (!is_coherent(map, i, sum < 0 ? -1 : 1, scale, scale_counts)) continue;
    note({i, false, map[i] / root * levels_[i].noise, first, last}, deviations);
  }
}

/// A touch that grows all the time looks like drift, but of neighbours together.
void TouchSearch::search_trends() {
  std::vector<double> slopes;
  for (const auto i : sampled_) slopes.push_back(levels_[i].slope);
  const double common = median(slopes);
  std::vector<float> map(levels_.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (used_[i] == 0) continue;
    map[i] = static_cast<float>((levels_[i].slope - common) * middle_ / levels_[i].noise);
  }
  search_map(map, 0, count_ - 1);
}

/// Finds spikes of a sensel, and a touch that it alone has: it leaves its level for long, at once
/// and to one side.
void TouchSearch::search_sensel(std::size_t i) {
  std::vector<Spike> spikes;
  std::size_t away = 0;
  std::size_t longest = 0;
  std::size_t first = count_;
  std::size_t last = 0;
  std::array<double, 2> farthest = {};
  double fastest = 0;
  double before = 0;
  const double noise = levels_[i].noise;
  for (std::size_t t = 0; t < count_;) {
    std::size_t end = t;
    for (; end < count_; ++end) {
      const double change = distance(end, i) / (noise * spreads_[end]);
      if (end > 0) fastest = std::max(fastest, std::abs(change - before));
      before = change;
      farthest[change < 0 ? 1 : 0] = std::max(farthest[change < 0 ? 1 : 0], std::abs(change));
      if (std::abs(change) <= kSpikeDeviations) break;
    }
    const std::size_t length = end - t;
    away += length;
    longest = std::max(longest, length);
    if (length > 0 && length <= kSpikeFrames) {
      for (std::size_t at = t; at < end; ++at) {
        spikes.push_back({static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(i)});
      }
    } else if (length > 0) {
      first = std::min(first, t);
      last = end - 1;
    }
    t = end + 1;
  }
  const double far = std::max(farthest[0], farthest[1]);
  const double other = std::min(farthest[0], farthest[1]);
  if (longest > kSpikeFrames && other < 0.5 * kSpikeDeviations && fastest > far / 3) {
    return note({i, false, far * noise * (farthest[0] > farthest[1] ? 1 : -1), first, last}, far);
  }
  if (away > std::max(kSpikeFrames, count_ / kSpikeEach)) return;
  spikes_.insert(spikes_.end(), spikes.begin(), spikes.end());
}

/// Adds the frames without spikes to the statistics, and looks for what lasts, but is too weak to
/// be seen in one frame.
void TouchSearch::search_windows(ExaminedFrames& examined) {
  std::ranges::sort(spikes_);
  std::vector<float> readings(levels_.size());
  std::vector<float> last(levels_.size(), std::numeric_limits<float>::quiet_NaN());
  std::array<std::vector<float>, 2> sums;
  for (auto& each : sums) each.assign(levels_.size(), 0);
  constexpr std::array<std::size_t, 2> kLengths = {4, 16};
  auto spike = spikes_.begin();
  for (std::size_t t = 0; t < count_; ++t) {
    std::ranges::copy(frames_.readings(t), readings.begin());
    for (; spike != spikes_.end() && spike->frame == t; ++spike) {
      readings[spike->sensel] = std::numeric_limits<float>::quiet_NaN();
    }
    examined.still.add(readings);
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const double change = readings[i] - last[i];  // NaN: a spike
      if (change * change > 0) examined.noises[i] += change * change / 2;
    }
    std::ranges::copy(readings, last.begin());
    for (std::size_t n = 0; n < sums.size(); ++n) {
      for (std::size_t i = 0; i < readings.size(); ++i) {
        if (used_[i] == 0 || std::isnan(readings[i])) continue;
        sums[n][i] += static_cast<float>(distance(t, i) / levels_[i].noise);
      }
      if ((t + 1) % kLengths[n] != 0) continue;
      const auto root = static_cast<float>(std::sqrt(static_cast<double>(kLengths[n])));
      for (float& each : sums[n]) each /= root;
      search_map(sums[n], t + 1 - kLengths[n], t, root);
      std::ranges::fill(sums[n], 0.0F);
    }
  }
}

ExaminedFrames TouchSearch::run() {
  ExaminedFrames examined = {
      {}, FrameStatistics(frames_.name(), frames_.skin(), frames_.type()), {}, 0};
  examined.noises.assign(levels_.size(), 0);
  if (!sampled_.empty()) {
    find_common_changes();
    search_array();
    search_trends();
    std::vector<float> map(levels_.size());
    for (std::size_t t = 0; t < count_; ++t) {
      for (std::size_t i = 0; i < map.size(); ++i) {
        if (used_[i] != 0) map[i] = static_cast<float>(distance(t, i) / levels_[i].noise);
      }
      spreads_[t] = static_cast<float>(std::max(1.0, spread(map)));
      search_map(map, t, t);
    }
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      if (used_[i] != 0) search_sensel(i);
    }
  }
  search_windows(examined);
  for (double& each : examined.noises) each = std::sqrt(each / static_cast<double>(count_ - 1));
  examined.touch = touch_;
  examined.spikes = spikes_.size();
  return examined;
}

}  // namespace

ExaminedFrames examine_frames(const TareFrames& unloaded, std::span<const std::uint8_t> mask) {
  return TouchSearch(unloaded, mask).run();
}

}  // namespace pillarfield
