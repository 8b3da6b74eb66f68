#pragma once

#include <chrono>
#include <deque>

namespace pillarfield::viewer {

/// How long things took that were done in the last second, 4096 of them at most.
class RecentTimes {
 public:
  using Time = std::chrono::nanoseconds;

  void add(Time start, Time end);          ///< `end` not before that of the one before
  void forget_before(Time now);            ///< what is older than a second
  [[nodiscard]] double rate_hz() const;    ///< from one end to the next; 0 of less than two
  [[nodiscard]] double median_ms() const;  ///< 0 without any
  [[nodiscard]] double worst_ms() const;

 private:
  struct Span {
    Time end;
    double took_ms;
  };
  std::deque<Span> spans_;
};

}  // namespace pillarfield::viewer
