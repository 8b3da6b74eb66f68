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

void RecentTimes::add(Time end) {
  forget_before(end);
  if (times_.size() == kMost) times_.pop_front();
  times_.push_back(end);
}

void RecentTimes::forget_before(Time now) {
  while (!times_.empty() && times_.front() < now - kRecent) times_.pop_front();
}

double RecentTimes::rate_hz() const {
  if (times_.size() < 2) return 0;
  const std::chrono::duration<double> span = times_.back() - times_.front();
  return span.count() > 0 ? static_cast<double>(times_.size() - 1) / span.count() : 0;
}

}  // namespace pillarfield::viewer
