#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

constexpr double kNearlyAll = 0.99;
constexpr std::size_t kLeastPeaks = 3;  ///< different sensels with the largest reading
/// Change from frame to frame in the range of readings from which their bytes may be swapped, and
/// its ratio to that with the bytes swapped back.
constexpr double kWild = 0.02;
constexpr double kCalmer = 8;

void report_odd(Diagnosis& found, ArrayFault fault, double figure, std::string text) {
  found.findings.push_back({.fault = fault, .figure = figure, .text = std::move(text)});
}

/// Calls `use(frame, sensel, reading)` for the readings of sensels that vary.
template <class Use>
void for_each_varying(const Examination& seen, Use use) {
  for (std::size_t frame = 0; frame < seen.kept.frames(); ++frame) {
    const auto readings = std::as_const(seen.kept).frame(frame);
    for (std::size_t i = 0; i < readings.size(); ++i) {
      if (seen.constant[i] == 0 && !std::isnan(readings[i])) use(frame, i, readings[i]);
    }
  }
}

/// Each frame divided by its largest reading.
void find_normalised(const Examination& seen, Diagnosis& found) {
  std::vector<float> peaks(seen.kept.frames(), -std::numeric_limits<float>::infinity());
  for_each_varying(seen, [&](std::size_t frame, std::size_t, float reading) {
    peaks[frame] = std::max(peaks[frame], reading);
  });
  if (peaks.empty()) return;
  std::vector<std::size_t> counts(peaks.size());  // of sensels with the largest reading
  std::vector<std::size_t> places(peaks.size());  // the last of these
  for_each_varying(seen, [&](std::size_t frame, std::size_t sensel, float reading) {
    if (reading != peaks[frame]) return;
    ++counts[frame];
    places[frame] = sensel;
  });
  const auto equal = std::ranges::count(peaks, peaks.front());
  const std::set<std::size_t> different(places.begin(), places.end());
  if (static_cast<double>(equal) < kNearlyAll * static_cast<double>(peaks.size()) ||
      different.size() < kLeastPeaks || median(counts) > 2) {
    return;
  }
  report_odd(
      found, ArrayFault::normalised, peaks.front(),
      fmt::format("Normalised: the largest reading of every frame is {}, so that no force can "
                  "be had; record frames that are not scaled",
                  rounded(peaks.front())));
}

void find_two_values(const Examination& seen, Diagnosis& found) {
  std::set<float> values;
  for_each_varying(seen, [&](std::size_t, std::size_t, float reading) {
    if (values.size() < 3) values.insert(reading);
  });
  if (values.size() != 2) return;
  const double low = *values.begin();
  const double high = *values.rbegin();
  // Noise without load takes two neighbouring values, too.
  if (high - low <= 1) return;
  report_odd(
      found, ArrayFault::two_values, high,
      fmt::format("Two values: sensels read {} or {}, which shows contact, not force; record "
                  "readings that no threshold has cut",
                  rounded(low), rounded(high)));
}

std::uint16_t swapped(std::uint16_t value) {
  return static_cast<std::uint16_t>(value << 8U | value >> 8U);
}

/// Mean change of a reading from frame to frame, relative to the range of the readings.
double relative_change(const Examination& seen, bool swap) {
  const auto number = [&](float reading) {
    const auto value = static_cast<std::uint16_t>(reading);
    return static_cast<double>(swap ? swapped(value) : value);
  };
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  double changes = 0;
  double count = 0;
  for_each_varying(seen, [&](std::size_t frame, std::size_t i, float reading) {
    least = std::min(least, number(reading));
    most = std::max(most, number(reading));
    const float before = frame > 0 ? std::as_const(seen.kept).frame(frame - 1)[i] : reading;
    if (std::isnan(before)) return;
    changes += std::abs(number(reading) - number(before));
    ++count;
  });
  return most > least ? changes / count / (most - least) : 0;
}

/// Bytes in the wrong order, of readings that are 16-bit numbers.
void find_byte_order(const Examination& seen, Diagnosis& found) {
  bool are_whole = true;
  float most = 0;
  for_each_varying(seen, [&](std::size_t, std::size_t, float reading) {
    are_whole = are_whole && reading >= 0 && reading < 65536 && reading == std::floor(reading);
    most = std::max(most, reading);
  });
  if (!are_whole || most < 256) return;
  const double change = relative_change(seen, false);
  if (change < kWild || change < kCalmer * relative_change(seen, true)) return;
  report_odd(found, ArrayFault::byte_order, 100 * change,
             fmt::format("Byte order: readings jump by {:.0f} % of their range from frame to "
                         "frame, and do not with the two bytes of each swapped; swap them",
                         100 * change));
}

}  // namespace

void find_odd_frames(const Examination& seen, const FrameWatch& watch, Diagnosis& found) {
  const std::string all = counted(found.frames, "frame");
  if (watch.is_frozen()) {
    report_odd(found, ArrayFault::frozen, static_cast<double>(found.frames),
               fmt::format("Frozen: each of the {} is equal to the first; check that the board "
                           "still scans",
                           all));
    return;
  }
  const auto report = [&](bool is_odd, const FrameWatch::Count& count, ArrayFault fault,
                          const char* name, const std::string& words) {
    if (!is_odd) return;
    report_odd(found, fault, static_cast<double>(count.frames),
               fmt::format("{}: {} of {} {}, the first is frame {}", name, grouped(count.frames),
                           all, words, count.first));
  };
  report(watch.empty().frames > 0, watch.empty(), ArrayFault::missing_frames, "Missing",
         "have no reading");
  report(
      watch.uniform_are_lost(), watch.lost(), ArrayFault::missing_frames, "Missing",
      fmt::format("read {} everywhere between others that do not", rounded(watch.uniform_value())));
  report(watch.repeats_are_odd(), watch.repeated(), ArrayFault::repeated_frames, "Repeated",
         "equal the one before although readings are noisy");
  find_normalised(seen, found);
  find_two_values(seen, found);
  find_byte_order(seen, found);
}

}  // namespace pillarfield
