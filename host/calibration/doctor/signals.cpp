#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"
#include "calibration/neighbours.h"

namespace pillarfield {
namespace {

constexpr std::size_t kWindows = 24;
constexpr std::size_t kLeastWindowFrames = 8;
constexpr std::size_t kLeastDriftWindows = 6;
/// Least share of the largest signal of a frame that counts as load.
constexpr double kLoadShare = 0.1;
constexpr std::size_t kLeastLoaded = 3;
/// The same of a frame in which fewer sensels than that are loaded, in the usual largest signal.
constexpr double kSingleShare = 0.3;
/// Share of the largest span up to which a sensel may be at rest: drift is below a quarter.
constexpr double kAtRest = 0.35;
constexpr double kRestNoise = 7;  ///< range of the noise, in deviations
constexpr double kMostDrift = 0.3;
constexpr std::size_t kLeastRest = 10;      ///< frames
constexpr std::size_t kLoadedAtRest = 500;  ///< one of so many sensels
constexpr double kOddSpans = 0.01;          ///< share of the sensels
/// Sudden change of a load, in the range of its sensel and in noise.
constexpr double kSuddenStep = 0.25;
constexpr double kSuddenNoise = 8;
/// Multiples of the usual noise, and of that around, of sensels that do not tell of load.
constexpr double kUnsteady = 7;
constexpr double kUnsteadyAround = 5;
constexpr double kManyChanges = 0.6;  ///< share of the changes from frame to frame
constexpr double kFewChanges = 0.1;
constexpr double kMostOfJitter = 3;        ///< slow noise, in that from frame to frame
constexpr double kLeastDriftSeconds = 30;  ///< of frames without load
/// Least deviation of a whole number: rounding and a flicker.
constexpr double kRounding = 0.5;

/// A sensel's readings without load in each window of frames, as far as there are enough of them.
using RestWindows = std::vector<std::optional<double>>;

/// Mean of the readings no farther from `about` than noise is; it is finer than whole counts.
double mean_near(const std::vector<float>& readings, double about, double noise) {
  double sum = 0;
  double count = 0;
  for (const float reading : readings) {
    if (std::abs(reading - about) > 3 * std::max(noise, kRounding)) continue;
    sum += reading;
    ++count;
  }
  return count > 0 ? sum / count : about;
}

std::size_t window_count(std::size_t frames) {
  return std::clamp<std::size_t>(frames / kLeastWindowFrames, 1, kWindows);
}

/// The lower quartile of the windows' standard deviations: slow noise and hum count, too.
double noise_of_windows(const std::vector<float>& readings) {
  std::vector<double> squares;
  const std::size_t count = window_count(readings.size());
  for (std::size_t w = 0; w < count; ++w) {
    const std::size_t first = w * readings.size() / count;
    const std::size_t end = (w + 1) * readings.size() / count;
    double mean = 0;
    double sum = 0;
    for (std::size_t n = first; n < end; ++n) {
      const double step = readings[n] - mean;
      mean += step / static_cast<double>(n - first + 1);
      sum += step * (readings[n] - mean);
    }
    if (end - first >= 2) squares.push_back(sum / static_cast<double>(end - first - 1));
  }
  return squares.empty() ? 0 : std::sqrt(quantile(squares, 0.25));
}

/// Deviation from frame to frame of a share of the changes: load changes more slowly. `skipped`:
/// readings at an end of the range, which cuts their noise.
double jitter_of(const std::vector<float>& readings, float skipped, double share) {
  std::vector<float> changes;
  for (std::size_t n = 1; n < readings.size(); ++n) {
    if (readings[n] == skipped || readings[n - 1] == skipped) continue;
    changes.push_back(std::abs(readings[n] - readings[n - 1]));
  }
  if (changes.size() < kLeastWindowFrames) return 0;
  // Quantiles of a normal distribution's magnitude.
  const double deviations = share == kManyChanges ? 0.8416 : 0.1257;
  return quantile(changes, share) / (deviations * std::sqrt(2.0));
}

/// The reading at an end of the range that most readings have; NaN: there is none.
float reading_at_end(const std::vector<float>& readings, float lowest, float highest) {
  for (const float end : {lowest, highest}) {
    if (2 * std::ranges::count(readings, end) > std::ssize(readings)) return end;
  }
  return std::numeric_limits<float>::quiet_NaN();
}

/// The largest change between means of three readings, five frames apart: loads come and go so
/// fast, drift does not.
double largest_step(const std::vector<float>& readings) {
  double largest = 0;
  for (std::size_t n = 0; n + 8 <= readings.size(); ++n) {
    double step = 0;
    for (std::size_t k = 0; k < 3; ++k) step += readings[n + 5 + k] - readings[n + k];
    largest = std::max(largest, std::abs(step) / 3);
  }
  // A jump at the first frames, too, if it stays.
  for (std::size_t n = 0; n + 4 <= readings.size() && n < 3; ++n) {
    const auto [low, high] = std::minmax({readings[n + 1], readings[n + 2], readings[n + 3]});
    largest = std::max<double>({largest, low - readings[n], readings[n] - high});
  }
  return largest;
}

/// Median slope between windows, counts per window.
double slope_of(const RestWindows& windows, const std::vector<double>& without) {
  std::vector<double> slopes;
  for (std::size_t a = 0; a < without.size(); ++a) {
    for (std::size_t b = a + 1; b < without.size() && windows[a]; ++b) {
      if (!windows[b]) continue;
      slopes.push_back((*windows[b] - without[b] - *windows[a] + without[a]) /
                       static_cast<double>(b - a));
    }
  }
  return slopes.size() < kLeastDriftWindows * (kLeastDriftWindows - 1) / 2 ? 0 : median(slopes);
}

/// Median of the values of sensels that vary, and the one farthest from it.
SenselFigure figure_of(const Examination& seen, const std::vector<float>& values) {
  std::vector<float> varying;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (seen.constant[i] == 0) varying.push_back(values[i]);
  }
  SenselFigure figure;
  if (varying.empty()) varying = values;
  figure.median = median(varying);
  double farthest = -1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double distance = std::abs(values[i] - figure.median);
    if (seen.constant[i] != 0 || distance <= farthest) continue;
    farthest = distance;
    figure.worst = values[i];
    figure.place = seen.place(i);
  }
  return figure;
}

/// The mean of the readings near their lowest tenth: that without load, of a sensel without load a
/// tenth of the time. The readings rise under load and do not drift.
double idle_of(std::vector<float> readings, double noise) {
  constexpr double kTenth = 1.2816;  // of a normal distribution, in deviations
  const double about = quantile(readings, 0.1) + kTenth * noise;
  return mean_near(readings, about, noise);
}

/// Slopes of single sensels, no farther from 0 than most are.
void limit_slopes(const Examination& seen, std::vector<float>& slopes) {
  std::vector<double> sizes;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    if (seen.is_steady(i)) sizes.push_back(std::abs(slopes[i]));
  }
  if (sizes.empty()) return;
  const auto most = static_cast<float>(3 * median(sizes));
  for (float& slope : slopes) slope = std::clamp(slope, -most, most);
}

double seconds_per_frame(const KeptFrames& kept) {
  const std::vector<double>& times = kept.times();
  const double seconds = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  return seconds > 0 ? seconds : 0;
}

/// Sensels that are noisier than most and than those around them, which load moves, too.
void find_noisy(Examination& seen) {
  std::vector<float> around;
  for (std::size_t i = 0; i < seen.noise.size(); ++i) {
    if (seen.noise[i] <= kUnsteady * seen.typical_noise) continue;
    around.clear();
    for (const std::size_t n : Neighbours(seen.statistics.skin(), i).all()) {
      if (seen.constant[n] == 0) around.push_back(seen.noise[n]);
    }
    seen.noisy[i] = around.empty() || seen.noise[i] > kUnsteadyAround * median(around) ? 1 : 0;
  }
}

/// Noise of the sensels, and the range of what they read.
void find_noise_and_ranges(Examination& seen, Diagnosis& found) {
  const std::size_t sensels = seen.kept.sensels();
  std::vector<double> steps(sensels);
  seen.sudden.resize(sensels);
  float lowest = std::numeric_limits<float>::infinity();
  float highest = -lowest;
  for (std::size_t i = 0; i < sensels; ++i) {
    if (seen.constant[i] != 0) continue;
    lowest = std::min(lowest, seen.read[i].lowest);
    highest = std::max(highest, seen.read[i].highest);
  }
  SenselReadings readings;
  for (std::size_t i = 0; i < sensels; ++i) {
    if (seen.constant[i] != 0) continue;
    seen.kept.read_sensel(i, readings);
    if (readings.values.empty()) continue;
    steps[i] = largest_step(readings.values);
    const float none = std::numeric_limits<float>::quiet_NaN();
    seen.jitter[i] = static_cast<float>(jitter_of(readings.values, none, kManyChanges));
    const float end = reading_at_end(readings.values, lowest, highest);
    double noise = noise_of_windows(readings.values);
    if (seen.jitter[i] > 0) noise = std::min(noise, kMostOfJitter * seen.jitter[i]);
    seen.noise[i] = static_cast<float>(
        std::max(noise, std::isnan(end) ? 0 : jitter_of(readings.values, end, kFewChanges)));
    // Without the one lowest and the one highest reading, which may be a slip.
    const auto second =
        static_cast<std::ptrdiff_t>(std::min<std::size_t>(1, readings.values.size() - 1));
    std::ranges::nth_element(readings.values, readings.values.begin() + second);
    seen.lowest[i] = readings.values[static_cast<std::size_t>(second)];
    std::ranges::nth_element(readings.values, readings.values.end() - 1 - second);
    seen.highest[i] =
        readings.values[readings.values.size() - 1 - static_cast<std::size_t>(second)];
  }
  found.noise = figure_of(seen, seen.noise);
  seen.typical_noise = found.noise.median;
  if (seen.statistics.type() != SenselType::f32) {
    seen.typical_noise = std::max(seen.typical_noise, kRounding);
  }
  find_noisy(seen);
  std::vector<double> spans;
  for (std::size_t i = 0; i < sensels; ++i) {
    if (!seen.is_steady(i)) continue;
    const double span = double{seen.highest[i]} - seen.lowest[i];
    if (steps[i] < std::max(kSuddenStep * span, kSuddenNoise * seen.noise_of(i))) continue;
    seen.sudden[i] = 1;
    seen.has_load = true;
    spans.push_back(span);
  }
  if (!spans.empty()) seen.span = quantile(spans, 1 - kOddSpans);
}

/// The largest reading that may be without load, but for drift.
double most_at_rest(const Examination& seen, std::size_t sensel) {
  if (!seen.has_load) return std::numeric_limits<double>::infinity();
  const double most = kAtRest * seen.span;
  const double range = double{seen.highest[sensel]} - seen.lowest[sensel];
  const double noise = std::min(most, kRestNoise * seen.noise_of(sensel));
  return seen.lowest[sensel] + (seen.sudden[sensel] != 0 ? std::max(kAtRest * range, noise) : most);
}

/// Readings without load as a function of time: one curve for all sensels, a slope for each.
class Baseline {
 public:
  explicit Baseline(const Examination& seen)
      : seen_(seen),
        windows_(window_count(seen.kept.frames())),
        common_(windows_),
        slopes_(seen.kept.sensels()) {
    if (windows_ < kLeastDriftWindows) return;
    std::vector<RestWindows> rest;
    for (std::size_t i = 0; i < slopes_.size(); ++i) rest.push_back(rest_of(i));
    find_common(rest);
    for (std::size_t i = 0; i < slopes_.size(); ++i) {
      slopes_[i] = static_cast<float>(slope_of(rest[i], common_));
    }
    limit_slopes(seen, slopes_);
  }

  [[nodiscard]] double of(std::size_t sensel, std::size_t frame) const {
    if (seen_.constant[sensel] != 0) return 0;
    const double at = std::clamp(place_of(frame), 0.0, static_cast<double>(windows_ - 1));
    const auto before = static_cast<std::size_t>(at);
    const double next = before + 1 < windows_ ? common_[before + 1] : common_[before];
    return std::lerp(common_[before], next, at - static_cast<double>(before)) - common_.front() +
           slopes_[sensel] * (place_of(frame) - place_of(0));
  }

  /// Counts per kept frame; empty: too few frames.
  [[nodiscard]] std::vector<float> drifts() const {
    if (windows_ < kLeastDriftWindows) return {};
    const RestWindows curve(common_.begin(), common_.end());
    const double slope = slope_of(curve, std::vector<double>(windows_));
    std::vector<float> drifts = slopes_;
    for (float& each : drifts) {
      each = static_cast<float>((each + slope) * static_cast<double>(windows_) /
                                static_cast<double>(seen_.kept.frames()));
    }
    return drifts;
  }

 private:
  [[nodiscard]] double place_of(std::size_t frame) const {
    return (static_cast<double>(frame) + 0.5) * static_cast<double>(windows_) /
               static_cast<double>(seen_.kept.frames()) -
           0.5;
  }

  [[nodiscard]] RestWindows rest_of(std::size_t sensel) const {
    RestWindows rest(windows_);
    if (!seen_.is_steady(sensel)) return rest;
    const std::size_t frames = seen_.kept.frames();
    const double most = most_at_rest(seen_, sensel);
    std::vector<float> part;
    for (std::size_t w = 0; w < windows_; ++w) {
      const std::size_t first = w * frames / windows_;
      const std::size_t end = (w + 1) * frames / windows_;
      part.clear();
      for (std::size_t frame = first; frame < end; ++frame) {
        const float reading = std::as_const(seen_.kept).frame(frame)[sensel];
        if (reading < most) part.push_back(reading);
      }
      if (2 * part.size() < end - first || part.size() < 3) continue;
      const double middle = median(part);
      rest[w] = mean_near(part, middle, seen_.noise[sensel]);
    }
    return rest;
  }

  /// The sensels that are at rest in `least` windows.
  static std::vector<const RestWindows*> resting(const std::vector<RestWindows>& rest,
                                                 std::size_t least) {
    std::vector<const RestWindows*> found;
    for (const RestWindows& each : rest) {
      const auto count = std::ranges::count_if(each, [](const auto& m) { return m.has_value(); });
      if (static_cast<std::size_t>(count) >= least) found.push_back(&each);
    }
    return found;
  }

  /// Levels of sensels and a curve that explain the windows: medians of either, by turns. By the
  /// sensels that are mostly at rest, if there are enough of them.
  void find_common(const std::vector<RestWindows>& rest) {
    std::vector<const RestWindows*> used = resting(rest, 2 * windows_ / 3);
    if (used.size() < std::max<std::size_t>(4, rest.size() / 10)) used = resting(rest, 1);
    std::vector<double> levels(used.size());
    std::vector<double> values;
    for (int turn = 0; turn < 4; ++turn) {
      for (std::size_t n = 0; n < used.size(); ++n) {
        values.clear();
        for (std::size_t w = 0; w < windows_; ++w) {
          if ((*used[n])[w]) values.push_back(*(*used[n])[w] - common_[w]);
        }
        levels[n] = median(values);
      }
      double last = 0;
      for (std::size_t w = 0; w < windows_; ++w) {
        values.clear();
        for (std::size_t n = 0; n < used.size(); ++n) {
          if ((*used[n])[w]) values.push_back(*(*used[n])[w] - levels[n]);
        }
        if (!values.empty()) last = median(values);
        common_[w] = last;
      }
    }
    // A curve that goes as far as loads do is load.
    const auto [least, most] = std::ranges::minmax(common_);
    if (seen_.has_load && most - least > kMostDrift * seen_.span) common_.assign(windows_, 0);
  }

  const Examination& seen_;
  std::size_t windows_;
  std::vector<double> common_;  ///< at the middle of each window, counts
  std::vector<float> slopes_;   ///< counts per window
};

/// Reports drift if enough frames are without load.
void report_drift(const Examination& seen, const std::vector<float>& drifts, Diagnosis& found) {
  const std::size_t idle = seen.kept.frames() - seen.loaded_frames;
  const double seconds = seconds_per_frame(seen.kept);
  if (drifts.empty() || !(seconds * static_cast<double>(idle) >= kLeastDriftSeconds)) return;
  const double factor = (found.polarity == Polarity::falls ? -1 : 1) * 60 / seconds;
  SenselFigure drift = figure_of(seen, drifts);
  drift.median *= factor;
  drift.worst *= factor;
  found.drift = drift;
}

/// Makes readings that fall under load rise.
void turn_over(Examination& seen) {
  for (std::size_t frame = 0; frame < seen.kept.frames(); ++frame) {
    for (float& reading : seen.kept.frame(frame)) reading = -reading;
  }
  seen.lowest.swap(seen.highest);
  for (auto* const plane : {&seen.lowest, &seen.highest}) {
    for (float& reading : *plane) reading = -reading;
  }
}

/// Kept frames in which no sensel is loaded; none if they are few.
std::vector<std::uint8_t> frames_at_rest(const Examination& seen, const Baseline& baseline) {
  std::vector<std::uint8_t> at_rest(seen.kept.frames(), 1);
  std::size_t count = 0;
  for (std::size_t frame = 0; frame < at_rest.size(); ++frame) {
    const auto readings = std::as_const(seen.kept).frame(frame);
    std::size_t loaded = 0;
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const double most = most_at_rest(seen, i);
      loaded += seen.is_steady(i) && readings[i] - baseline.of(i, frame) > most ? 1U : 0U;
    }
    at_rest[frame] = kLoadedAtRest * loaded <= readings.size() ? 1 : 0;
    count += at_rest[frame];
  }
  if (count < kLeastRest) at_rest.clear();
  return at_rest;
}

/// Replaces the readings by signals.
void take_signals(Examination& seen, const Baseline& baseline, float sign) {
  KeptFrames& kept = seen.kept;
  const std::vector<std::uint8_t> at_rest = frames_at_rest(seen, baseline);
  SenselReadings readings;
  std::vector<float> rest;
  for (std::size_t i = 0; i < kept.sensels(); ++i) {
    kept.read_sensel(i, readings);
    for (std::size_t frame = 0; frame < kept.frames(); ++frame) kept.frame(frame)[i] = 0;
    rest.clear();
    for (std::size_t n = 0; n < readings.values.size(); ++n) {
      readings.values[n] -= static_cast<float>(baseline.of(i, readings.frames[n]));
      const auto most = static_cast<float>(most_at_rest(seen, i));
      const bool is_rest =
          at_rest.empty() ? readings.values[n] < most : at_rest[readings.frames[n]] != 0;
      if (is_rest) rest.push_back(readings.values[n]);
    }
    if (rest.empty()) rest = readings.values;
    if (rest.empty()) continue;
    const double idle = idle_of(rest, seen.noise[i]);
    seen.idle[i] = sign * static_cast<float>(idle);
    for (std::size_t n = 0; n < readings.values.size(); ++n) {
      kept.frame(readings.frames[n])[i] = readings.values[n] - static_cast<float>(idle);
    }
  }
}

/// The largest signal of the steady sensels, and how many are loaded.
struct LoadOfFrame {
  float peak = 0;
  std::size_t loaded = 0;
};

LoadOfFrame load_of(const Examination& seen, std::size_t frame) {
  const auto signals = std::as_const(seen.kept).frame(frame);
  LoadOfFrame load;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (!seen.is_steady(i) || !(signals[i] > 1.5 * seen.threshold(i))) continue;
    ++load.loaded;
    load.peak = std::max(load.peak, signals[i]);
  }
  return load;
}

/// Frames with a contact: some loaded sensels, or one that is loaded as much as usual.
void find_contacts(Examination& seen, Diagnosis& found) {
  std::vector<LoadOfFrame> loads;
  std::vector<float> peaks;
  if (!seen.has_load) return;
  for (std::size_t frame = 0; frame < seen.kept.frames(); ++frame) {
    loads.push_back(load_of(seen, frame));
    if (loads.back().loaded > 0) peaks.push_back(loads.back().peak);
  }
  seen.loaded_frames = peaks.size();
  if (peaks.empty()) return;
  const double usual = seen.usual_peak = quantile(peaks, 0.9);
  peaks.clear();
  for (std::uint32_t frame = 0; frame < loads.size(); ++frame) {
    const LoadOfFrame& load = loads[frame];
    if (!(load.peak > (load.loaded < kLeastLoaded ? kSingleShare : kLoadShare) * usual)) continue;
    seen.contacts.push_back(frame);
    peaks.push_back(load.peak);
  }
  seen.contact_counts = median(peaks);
  for (const std::uint32_t frame : seen.contacts) {
    const auto signals = std::as_const(seen.kept).frame(frame);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (signals[i] > std::max(seen.threshold(i), kLoadShare * seen.contact_counts)) {
        ++seen.touched[i];
      }
    }
  }
  const auto first =
      std::ranges::find_if(loads, [](const LoadOfFrame& load) { return load.loaded > 0; });
  const auto idle = static_cast<std::uint64_t>(first - loads.begin());
  found.idle_frames = idle == 0 ? 0 : seen.kept.number(idle - 1) + 1;
}

}  // namespace

void find_signals(Examination& seen, Diagnosis& found) {
  find_noise_and_ranges(seen, found);
  if (seen.has_load) found.polarity = find_polarity(seen);
  if (found.polarity == Polarity::falls) turn_over(seen);
  const Baseline baseline(seen);
  const std::vector<float> drifts = baseline.drifts();
  take_signals(seen, baseline, found.polarity == Polarity::falls ? -1 : 1);
  found.idle_counts = figure_of(seen, seen.idle).median;
  found.idle_frames = found.frames;
  if (found.polarity != Polarity::unknown) find_contacts(seen, found);
  if (found.polarity == Polarity::unknown && seen.has_load) found.idle_frames = 0;
  if (seen.contacts.empty()) found.polarity = Polarity::unknown;
  if (!seen.contacts.empty() || !seen.has_load) report_drift(seen, drifts, found);
  found.contact_counts = seen.contact_counts;
  found.contact_frames = seen.contacts.size();
}

}  // namespace pillarfield
