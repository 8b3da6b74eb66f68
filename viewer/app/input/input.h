#pragma once

#include <cstdint>
#include <variant>

#include "viewer/style/view.h"

namespace pillarfield::viewer {

// What a hand did, in the order in which it did it. Pixels are those of the window, from its upper
// left corner; keys are GLFW's codes, letters by what the layout of the keyboard has written there.

struct Modifiers {
  bool shift = false;
  bool control = false;
  friend bool operator==(const Modifiers&, const Modifiers&) = default;
};

enum class MouseButton : std::uint8_t { left, right, middle };

struct KeyEvent {
  int key = 0;
  Modifiers modifiers;
  bool pressed = true;    ///< false: let go
  bool unusable = false;  ///< pressed with a modifier that nothing here uses
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
  double steps = 0;  ///< away from the hand
  Vec2 pixel;
};

using InputEvent =
    std::variant<KeyEvent, TextEvent, MotionEvent, LeaveEvent, ButtonEvent, WheelEvent>;

}  // namespace pillarfield::viewer
