#include <algorithm>
#include <cmath>
#include <utility>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

constexpr std::size_t kWindows = 24;
constexpr std::size_t kLeastWindowFrames = 8;
constexpr std::size_t kLeastDriftWindows = 6;
/// Least share of the largest signal of a frame that counts as load.
constexpr double kLoadShare = 0.1;
constexpr std::size_t kLeastLoaded = 3;
/// Deviation of a rounded number.
const double kRounding = 1 / std::sqrt(12.0);

/// What a sensel reads in each window of frames.
struct ReadingWindows {
  std::vector<double> middle;  ///< means of readings near the median
  std::vector<double> centre;  ///< frame in the middle of the window
  double noise = 0;
};

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

/// Middles of the windows, and the noise: the lower quartile of the windows' differences from
/// frame to frame.
ReadingWindows windows_of(const SenselReadings& readings) {
  ReadingWindows windows;
  const std::size_t size = readings.values.size();
  const std::size_t count = std::clamp<std::size_t>(size / kLeastWindowFrames, 1, kWindows);
  std::vector<double> squares;
  std::vector<float> part;
  for (std::size_t w = 0; w < count; ++w) {
    const std::size_t first = w * size / count;
    const std::size_t end = (w + 1) * size / count;
    if (end - first < 2) continue;
    part.assign(readings.values.begin() + static_cast<std::ptrdiff_t>(first),
                readings.values.begin() + static_cast<std::ptrdiff_t>(end));
    double sum = 0;
    for (std::size_t i = 1; i < part.size(); ++i) sum += std::pow(part[i] - part[i - 1], 2);
    squares.push_back(sum / (2.0 * static_cast<double>(part.size() - 1)));
    const double middle = median(part);
    windows.middle.push_back(mean_near(part, middle, std::sqrt(squares.back())));
    windows.centre.push_back((readings.frames[first] + readings.frames[end - 1]) / 2.0);
  }
  if (!squares.empty()) windows.noise = std::sqrt(quantile(squares, 0.25));
  return windows;
}

/// Median slope between windows, counts per frame.
double slope_of(const ReadingWindows& windows) {
  std::vector<double> slopes;
  for (std::size_t a = 0; a < windows.middle.size(); ++a) {
    for (std::size_t b = a + 1; b < windows.middle.size(); ++b) {
      const double frames = windows.centre[b] - windows.centre[a];
      if (frames > 0) slopes.push_back((windows.middle[b] - windows.middle[a]) / frames);
    }
  }
  return slopes.size() < kLeastDriftWindows ? 0 : median(slopes);
}

/// Median of the values of sensels that vary, and the one farthest from it.
SenselFigure figure_of(const Examination& seen, const std::vector<float>& values) {
  std::vector<float> varying;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (seen.constant[i] == 0) varying.push_back(values[i]);
  }
  SenselFigure figure;
  if (varying.empty()) return figure;
  figure.median = median(varying);
  double farthest = -1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double distance = std::abs(values[i] - figure.median);
    if (seen.constant[i] != 0 || distance <= farthest) continue;
    farthest = distance;
    figure.worst = values[i];
    figure.place = {static_cast<std::uint32_t>(i / seen.cols),
                    static_cast<std::uint32_t>(i % seen.cols)};
  }
  return figure;
}

/// The mean of the readings near their lowest tenth: that without load, of a sensel without load a
/// tenth of the time. SenselReadings rise under load and do not drift.
double idle_of(std::vector<float> readings, double noise) {
  constexpr double kTenth = 1.2816;  // of a normal distribution, in deviations
  const double about = quantile(readings, 0.1) + kTenth * noise;
  return mean_near(readings, about, noise);
}

/// Slopes of single sensels, no farther from the common one than most are.
void limit_slopes(const Examination& seen, std::vector<float>& slopes, double common) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    if (seen.constant[i] == 0) distances.push_back(std::abs(slopes[i] - common));
  }
  if (distances.empty()) return;
  const double most = 3 * median(distances);
  for (float& slope : slopes) {
    slope = static_cast<float>(std::clamp<double>(slope, common - most, common + most));
  }
}

double seconds_per_frame(const KeptFrames& kept) {
  const std::vector<double>& times = kept.times();
  const double seconds = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  return seconds > 0 ? seconds : 0;
}

/// Noise and slopes of the sensels, and what becomes of the diagnosis.
std::vector<float> find_noise_and_drift(Examination& seen, Diagnosis& found) {
  const std::size_t sensels = seen.kept.sensels();
  std::vector<float> slopes(sensels);
  SenselReadings readings;
  std::size_t windows_used = 0;
  for (std::size_t i = 0; i < sensels; ++i) {
    if (seen.constant[i] != 0) continue;
    seen.kept.read_sensel(i, readings);
    const ReadingWindows windows = windows_of(readings);
    seen.noise[i] = static_cast<float>(windows.noise);
    slopes[i] = static_cast<float>(slope_of(windows));
    windows_used = std::max(windows_used, windows.middle.size());
  }
  found.noise = figure_of(seen, seen.noise);
  seen.typical_noise = found.noise.median;
  if (seen.statistics.type() != SenselType::f32) {
    seen.typical_noise = std::max(seen.typical_noise, kRounding);
  }
  if (windows_used < kLeastDriftWindows) {
    slopes.assign(sensels, 0);
    return slopes;
  }
  limit_slopes(seen, slopes, figure_of(seen, slopes).median);
  const double seconds = seconds_per_frame(seen.kept);
  const double factor = seconds > 0 ? 60 / seconds : static_cast<double>(seen.kept.frames());
  SenselFigure drift = figure_of(seen, slopes);
  drift.median *= factor;
  drift.worst *= factor;
  found.drift = drift;
  return slopes;
}

/// Replaces the readings of a sensel by its signals.
void take_signals(Examination& seen, std::size_t sensel, float slope, float sign) {
  KeptFrames& kept = seen.kept;
  SenselReadings readings;
  kept.read_sensel(sensel, readings);
  for (std::size_t frame = 0; frame < kept.frames(); ++frame) kept.frame(frame)[sensel] = 0;
  if (readings.values.empty()) return;
  std::vector<float> still = readings.values;
  for (std::size_t n = 0; n < still.size(); ++n) {
    still[n] = sign * (still[n] - slope * static_cast<float>(readings.frames[n]));
  }
  const double idle = idle_of(still, seen.noise[sensel]);
  seen.idle[sensel] = sign * static_cast<float>(idle);
  for (std::size_t n = 0; n < still.size(); ++n) {
    kept.frame(readings.frames[n])[sensel] = still[n] - static_cast<float>(idle);
  }
}

/// Frames with a contact: at least three loaded sensels.
void find_contacts(Examination& seen) {
  std::vector<float> peaks;
  for (std::uint32_t frame = 0; frame < seen.kept.frames(); ++frame) {
    const auto signals = std::as_const(seen.kept).frame(frame);
    float peak = 0;
    std::size_t loaded = 0;
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (!(signals[i] > 1.5 * seen.threshold(i))) continue;
      ++loaded;
      peak = std::max(peak, signals[i]);
    }
    if (loaded < kLeastLoaded) continue;
    seen.contacts.push_back(frame);
    peaks.push_back(peak);
  }
  if (!peaks.empty()) seen.contact_counts = median(peaks);
  for (const std::uint32_t frame : seen.contacts) {
    const auto signals = std::as_const(seen.kept).frame(frame);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (signals[i] > std::max(seen.threshold(i), kLoadShare * seen.contact_counts)) {
        ++seen.touched[i];
      }
    }
  }
}

}  // namespace

double Examination::threshold(std::size_t sensel) const {
  return kBeyondIdleNoise * std::max<double>(noise[sensel], typical_noise);
}

void find_signals(Examination& seen, Diagnosis& found) {
  const std::vector<float> slopes = find_noise_and_drift(seen, found);
  found.polarity = find_polarity(seen, slopes);
  const float sign = found.polarity == Polarity::falls ? -1 : 1;
  for (std::size_t i = 0; i < seen.kept.sensels(); ++i) take_signals(seen, i, slopes[i], sign);
  found.idle_counts = figure_of(seen, seen.idle).median;
  found.idle_frames = found.frames;
  if (found.polarity == Polarity::unknown) return;
  find_contacts(seen);
  if (seen.contacts.empty()) found.polarity = Polarity::unknown;
  found.contact_counts = seen.contact_counts;
  found.contact_frames = seen.contacts.size();
  if (!seen.contacts.empty()) found.idle_frames = seen.contacts.front() * seen.kept.stride();
}

}  // namespace pillarfield
