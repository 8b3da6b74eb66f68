#pragma once

#include <optional>

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

}  // namespace pillarfield::viewer
