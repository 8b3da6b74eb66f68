#include "viewer/source/recent_times.h"

#include <algorithm>
#include <vector>

namespace pillarfield::viewer {
namespace {

constexpr std::size_t kMost = 4096;
constexpr RecentTimes::Time kRecent = std::chrono::seconds(1);

}  // namespace

void RecentTimes::add(Time start, Time end) {
  forget_before(end);
  if (spans_.size() == kMost) spans_.pop_front();
  spans_.push_back({end, std::chrono::duration<double, std::milli>(end - start).count()});
}

void RecentTimes::forget_before(Time now) {
  while (!spans_.empty() && spans_.front().end < now - kRecent) spans_.pop_front();
}

double RecentTimes::rate_hz() const {
  if (spans_.size() < 2) return 0;
  const std::chrono::duration<double> span = spans_.back().end - spans_.front().end;
  return span.count() > 0 ? static_cast<double>(spans_.size() - 1) / span.count() : 0;
}

double RecentTimes::median_ms() const {
  if (spans_.empty()) return 0;
  std::vector<double> times(spans_.size());
  std::ranges::transform(spans_, times.begin(), &Span::took_ms);
  const auto middle = times.begin() + std::ssize(times) / 2;
  std::ranges::nth_element(times, middle);
  return *middle;
}

double RecentTimes::worst_ms() const {
  if (spans_.empty()) return 0;
  return std::ranges::max_element(spans_, {}, &Span::took_ms)->took_ms;
}

}  // namespace pillarfield::viewer
