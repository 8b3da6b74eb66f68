#pragma once

#include <chrono>
#include <deque>
#include <vector>

namespace pillarfield::viewer {

/// The upper of the middle values; 0 for none.
[[nodiscard]] double median_of(std::vector<double> values);

/// Durations of the events of the last second, at most 4096.
class RecentTimes {
 public:
  using Time = std::chrono::nanoseconds;

  void add(Time end, double took_ms);      ///< `end` must not decrease
  void forget_before(Time now);            ///< drops events older than a second
  [[nodiscard]] double rate_hz() const;    ///< of ends; 0 for fewer than two
  [[nodiscard]] double median_ms() const;  ///< 0 for none

 private:
  struct Span {
    Time end;
    double took_ms;
  };
  std::deque<Span> spans_;
};

}  // namespace pillarfield::viewer
