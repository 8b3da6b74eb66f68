#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "viewer/source/recent_times.h"

namespace pillarfield::viewer {

/// Schedules drawing of the window, so that an idle window costs nothing. The caller passes times,
/// in seconds.
class Redraws {
 public:
  /// An event of keys, mouse or window; its effects may show a frame late.
  void input(double now_s);
  void field();               ///< a new field arrived
  void notice(double now_s);  ///< a new notice, which expires

  /// True if the window must be drawn now.
  [[nodiscard]] bool due(double now_s) const;

  /// Time to wait without events; none: no limit.
  [[nodiscard]] std::optional<double> rest(double now_s) const;

  void drawn(double now_s);

  /// The notice has expired.
  [[nodiscard]] bool notice_is_old(double now_s) const;
  void forget_notice() { notice_ends_s_.reset(); }

 private:
  int frames_ = 1;
  bool settling_ = false;  ///< draw once more when the measured rates have decayed
  double settled_s_ = 0;
  std::optional<double> notice_ends_s_;
};

/// Statistics of drawing over all frames.
class DrawClock {
 public:
  /// Adds a frame; `latency_ms` only for the first picture of a field.
  void add(double draw_ms, std::optional<double> latency_ms) {
    draw_ms_.push_back(draw_ms);
    if (latency_ms) latency_ms_.push_back(*latency_ms);
  }

  [[nodiscard]] std::uint64_t frames() const { return draw_ms_.size(); }
  /// Over all frames, and over all fields; 0 for none.
  [[nodiscard]] double draw_ms_median() const { return median_of(draw_ms_); }
  [[nodiscard]] double latency_ms_median() const { return median_of(latency_ms_); }

 private:
  std::vector<double> draw_ms_;
  std::vector<double> latency_ms_;
};

}  // namespace pillarfield::viewer
