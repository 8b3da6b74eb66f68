#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "viewer/app/app_state.h"

namespace pillarfield::viewer {

/// Statistics of drawing over the last second and over all frames. The caller passes times.
class DrawClock {
 public:
  /// Adds a frame presented at `now_s`; `latency_ms` only for the first picture of a field.
  void add(double now_s, double draw_ms, std::optional<double> latency_ms);

  /// Statistics of the second before `now_s`.
  [[nodiscard]] DrawStatistics lately(double now_s) const;

  [[nodiscard]] std::uint64_t frames() const { return draw_ms_.size(); }
  [[nodiscard]] double draw_ms_median() const;     ///< over all frames; 0 for none
  [[nodiscard]] double latency_ms_median() const;  ///< over all fields; 0 for none

 private:
  struct Frame {
    double now_s = 0;
    float draw_ms = 0;
    std::optional<float> latency_ms;
  };
  std::deque<Frame> recent_;
  std::vector<float> draw_ms_;
  std::vector<float> latency_ms_;
};

}  // namespace pillarfield::viewer
