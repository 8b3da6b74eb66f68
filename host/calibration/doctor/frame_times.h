#pragma once

#include <cstdint>
#include <vector>

#include "pillarfield/doctor.h"

namespace pillarfield {

/// Interval, jitter and gaps of frames, one after the other. Memory: 32 kB.
class FrameTimes {
 public:
  /// Adds the time of the next frame, s; NaN: it has none.
  void add(double time_s);

  [[nodiscard]] FrameTiming timing() const;

 private:
  struct Interval {
    std::uint64_t frame;
    double time_s;
    double length_s;
  };
  /// Intervals, of which those longer than 1.5 periods are gaps.
  struct Count {
    FrameTiming found;
    std::uint64_t intervals = 0;
    double mean = 0;
    double squares = 0;

    void add(const Interval& interval, double period_s);
  };
  [[nodiscard]] double period() const;

  std::uint64_t frames_ = 0;
  double last_s_ = 0;
  std::vector<Interval> first_;  ///< the first intervals, from which the period follows
  double period_s_ = 0;          ///< 0: not known yet
  Count count_;                  ///< once the period is known
};

}  // namespace pillarfield
