#pragma once

#include <optional>

namespace pillarfield::viewer {

/// When the window is to be drawn, and for how long there is nothing to do: an idle window costs
/// nothing. Times are given, in seconds.
class Redraws {
 public:
  /// A key, the mouse, the window: what they change may show a frame late.
  void input(double now_s);
  void field();               ///< a new one is there
  void notice(double now_s);  ///< a line to be read, and to go away after a while

  /// Whether to draw now.
  [[nodiscard]] bool due(double now_s) const;

  /// How long nothing is to be done, unless something happens; none: for ever.
  [[nodiscard]] std::optional<double> rest(double now_s) const;

  void drawn(double now_s);

  /// The line was there for long enough.
  [[nodiscard]] bool notice_is_old(double now_s) const;
  void forget_notice() { notice_ends_s_.reset(); }

 private:
  int frames_ = 1;
  bool settling_ = false;  ///< measured rates still show what was, and are drawn once more
  double settled_s_ = 0;
  std::optional<double> notice_ends_s_;
};

}  // namespace pillarfield::viewer
