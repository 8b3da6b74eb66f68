#include "viewer/source/recent_times.h"

#include <algorithm>

namespace pillarfield::viewer {
namespace {

constexpr std::size_t kMost = 4096;
constexpr RecentTimes::Time kRecent = std::chrono::seconds(1);

}  // namespace

double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

void RecentTimes::add(Time end, double took_ms) {
  forget_before(end);
  if (spans_.size() == kMost) spans_.pop_front();
  spans_.push_back({end, took_ms});
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
  std::vector<double> times(spans_.size());
  std::ranges::transform(spans_, times.begin(), &Span::took_ms);
  return median_of(std::move(times));
}

}  // namespace pillarfield::viewer
