#pragma once

#include <optional>

#include "viewer/app/input/shortcuts.h"

namespace pillarfield::viewer {

inline constexpr double kDoubleClickSeconds = 0.35;

/// Translates key and mouse events in the field into actions, independent of a window.
///
/// A click (press and release in one place) toggles a pin; a double click resets the view and
/// restores the pin. A drag moves a top view and turns a 3-D view, which Shift or another button
/// moves.
class Controls {
 public:
  void take(const InputEvent& event, const Command& command);

  /// True while a button that was pressed in the field is held.
  [[nodiscard]] bool is_dragging() const { return drag_.has_value(); }

  /// The cursor over the field; none elsewhere.
  [[nodiscard]] std::optional<Vec2> cursor() const { return cursor_; }

  /// Updates the pillar under the cursor after a change of view or field.
  void hover(const Command& command) const;

 private:
  struct Drag {
    MouseButton button;
    bool turns;  ///< a 3-D view; else moves the view
    Vec2 begin;  ///< position of the press
    Vec2 last;   ///< last position
    bool moved;  ///< beyond the tolerance of a click
  };
  struct Click {
    double time_s;
    Vec2 pixel;
  };

  void press(const ButtonEvent& event, const Command& command);
  void release(const ButtonEvent& event, const Command& command);
  void move(Vec2 pixel, const Command& command);
  static void turn_wheel(const WheelEvent& event, const Command& command);
  void click(const ButtonEvent& event, const Command& command);

  std::optional<Drag> drag_;
  std::optional<Click> last_click_;
  std::optional<Vec2> cursor_;
};

}  // namespace pillarfield::viewer
