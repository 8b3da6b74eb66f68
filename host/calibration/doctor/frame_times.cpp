#include "calibration/doctor/frame_times.h"

#include <algorithm>
#include <cmath>

#include "base/quantile.h"

namespace pillarfield {
namespace {

constexpr std::size_t kPeriodIntervals = 1024;
constexpr double kGapPeriods = 1.5;
constexpr std::size_t kListedGaps = 20;

}  // namespace

void FrameTimes::add(double time_s) {
  const std::uint64_t frame = frames_++;
  const double length = time_s - last_s_;
  last_s_ = time_s;
  if (frame == 0 || !std::isfinite(length)) return;
  const Interval interval = {frame, time_s, length};
  if (period_s_ > 0) return count_.add(interval, period_s_);
  first_.push_back(interval);
  if (first_.size() < kPeriodIntervals) return;
  period_s_ = period();
  for (const Interval& each : first_) count_.add(each, period_s_);
  first_.clear();
}

/// Median of the first intervals.
double FrameTimes::period() const {
  std::vector<double> lengths;
  for (const Interval& each : first_) lengths.push_back(each.length_s);
  return lengths.empty() ? 0 : median(lengths);
}

void FrameTimes::Count::add(const Interval& interval, double period_s) {
  if (interval.length_s > kGapPeriods * period_s) {
    ++found.gap_count;
    found.lost += static_cast<std::uint64_t>(
        std::max(1.0, std::min(1e15, std::round(interval.length_s / period_s) - 1)));
    if (found.gaps.size() < kListedGaps) {
      found.gaps.push_back({interval.frame, interval.time_s, interval.length_s});
    }
    return;
  }
  ++intervals;
  const double step = interval.length_s - mean;
  mean += step / static_cast<double>(intervals);
  squares += step * (interval.length_s - mean);
}

FrameTiming FrameTimes::timing() const {
  Count count = count_;
  const double period_s = period_s_ > 0 ? period_s_ : period();
  if (!(period_s > 0)) return {};
  for (const Interval& each : first_) count.add(each, period_s);
  FrameTiming timing = count.found;
  timing.rate_hz = 1 / period_s;
  if (count.intervals > 1) {
    timing.jitter_ms = 1e3 * std::sqrt(count.squares / static_cast<double>(count.intervals - 1));
  }
  return timing;
}

}  // namespace pillarfield
