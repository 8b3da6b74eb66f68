#pragma once

#include <array>
#include <span>

#include "viewer/app/input/input.h"

namespace pillarfield::viewer {

/// Tells Dear ImGui what the hand did. A button that goes down and up between two frames is held
/// for one, so that no click is lost.
class GuiInput {
 public:
  void take(const InputEvent& event);

  /// Whether a list of choices lies open over the window, and closes it.
  [[nodiscard]] static bool has_open_list();
  static void close_lists();

  /// Before each frame of ImGui, with its context current.
  void begin_frame(double seconds_since_last);

 private:
  struct Button {
    bool held = false;
    bool went_down = false;
  };
  std::array<Button, 3> buttons_;
};

}  // namespace pillarfield::viewer
