#pragma once

#include <cstdint>
#include <variant>

#include "viewer/style/view.h"

namespace pillarfield::viewer {

// Input events in order. Pixels count from the window's upper left corner; keys are GLFW codes,
// letters by keyboard layout.

struct Modifiers {
  bool shift = false;
  bool control = false;
  friend bool operator==(const Modifiers&, const Modifiers&) = default;
};

enum class MouseButton : std::uint8_t { left, right, middle };

struct KeyEvent {
  int key = 0;
  Modifiers modifiers;
  bool pressed = true;    ///< false: released
  bool unusable = false;  ///< pressed with an unsupported modifier
};

struct TextEvent {
  std::uint32_t character = 0;
};

struct MotionEvent {
  Vec2 pixel;
};

struct LeaveEvent {};  ///< the mouse left the window

struct ButtonEvent {
  MouseButton button = MouseButton::left;
  bool pressed = true;
  Modifiers modifiers;
  Vec2 pixel;
  double time_s = 0;
};

struct WheelEvent {
  double steps = 0;  ///< positive away from the user
  Vec2 pixel;
};

using InputEvent =
    std::variant<KeyEvent, TextEvent, MotionEvent, LeaveEvent, ButtonEvent, WheelEvent>;

}  // namespace pillarfield::viewer
