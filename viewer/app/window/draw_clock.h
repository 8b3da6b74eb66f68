#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "viewer/app/app_state.h"

namespace pillarfield::viewer {

/// Measures drawing: over the last second for the eye, and over all frames for a report. Times are
/// given; it has no clock.
class DrawClock {
 public:
  /// A frame was drawn and handed to the display at `now_s`. `latency_ms`: only where it showed a
  /// field for the first time.
  void add(double now_s, double draw_ms, std::optional<double> latency_ms);

  /// Of the second before `now_s`.
  [[nodiscard]] DrawStatistics lately(double now_s) const;

  [[nodiscard]] std::uint64_t frames() const { return draw_ms_.size(); }
  [[nodiscard]] double draw_ms_median() const;     ///< of all frames; 0 where there is none
  [[nodiscard]] double latency_ms_median() const;  ///< of all fields; 0 where there is none

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
