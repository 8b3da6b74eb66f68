#pragma once

#include <chrono>
#include <deque>
#include <vector>

namespace pillarfield::viewer {

/// The upper of the middle values; 0 for none.
[[nodiscard]] double median_of(std::vector<double> values);

/// Times of the events of the last second, at most 4096.
class RecentTimes {
 public:
  using Time = std::chrono::nanoseconds;

  void add(Time end);                    ///< must not decrease
  void forget_before(Time now);          ///< drops events older than a second
  [[nodiscard]] double rate_hz() const;  ///< 0 for fewer than two

 private:
  std::deque<Time> times_;
};

}  // namespace pillarfield::viewer
