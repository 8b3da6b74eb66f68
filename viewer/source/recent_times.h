#pragma once

#include <chrono>
#include <deque>

namespace pillarfield::viewer {

/// Durations of the events of the last second, at most 4096.
class RecentTimes {
 public:
  using Time = std::chrono::nanoseconds;

  void add(Time start, Time end);          ///< `end` must not decrease
  void forget_before(Time now);            ///< drops events older than a second
  [[nodiscard]] double rate_hz() const;    ///< of ends; 0 for fewer than two
  [[nodiscard]] double median_ms() const;  ///< 0 for none
  [[nodiscard]] double worst_ms() const;

 private:
  struct Span {
    Time end;
    double took_ms;
  };
  std::deque<Span> spans_;
};

}  // namespace pillarfield::viewer
