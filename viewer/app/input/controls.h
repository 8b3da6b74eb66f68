#pragma once

#include <optional>

#include "viewer/app/input/shortcuts.h"

namespace pillarfield::viewer {

/// What keys and the mouse in the field do to a session. Knows no window: events come from there,
/// or from a test.
///
/// A press and release in one place is a click: it pins the pillar or takes its pin away. Two in
/// quick succession reset the view, and the pin is what it was before. A drag marks a region of a
/// top view, turns a 3-D view, and with Shift or another button moves either.
class Controls {
 public:
  void take(const InputEvent& event, const Command& command);

  /// Whether a button went down in the field and is still held.
  [[nodiscard]] bool is_dragging() const { return drag_.has_value(); }

  /// The cursor over the field; none elsewhere.
  [[nodiscard]] std::optional<Vec2> cursor() const { return cursor_; }

  /// Looks again what is under the cursor: the view or the source has changed.
  void hover(const Command& command) const;

 private:
  enum class Purpose : std::uint8_t { mark, orbit, pan };
  struct Drag {
    MouseButton button;
    Purpose purpose;
    Vec2 begin;       ///< where the button went down
    Vec2 last;        ///< where the mouse was last
    bool moved;       ///< further than a hand shakes
    Vec2 begin_mm{};  ///< of a top view
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
