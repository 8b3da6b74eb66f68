#pragma once

#include <array>
#include <span>
#include <vector>

#include "viewer/app/input/controls.h"

namespace pillarfield::viewer {

/// Passes input events to Dear ImGui. Holds a button or key pressed and released between two frames
/// for one frame, so that no click and no key is lost.
class GuiInput {
 public:
  void take(const InputEvent& event);

  /// Queries and closes popup lists.
  [[nodiscard]] static bool has_open_list();
  static void close_lists();

  /// Call it before each ImGui frame, with its context current.
  void begin_frame(double seconds_since_last);

 private:
  struct Button {
    bool held = false;
    bool went_down = false;
  };
  void take_key(const KeyEvent& event);

  std::array<Button, 3> buttons_;
  std::vector<int> pressed_;   ///< keys, since the last frame
  std::vector<int> released_;  ///< of these
  std::vector<int> ending_;    ///< released in the frame after the next
};

/// Sends an event to the controls of the field, which lies at `field`, or to Dear ImGui. Text input
/// suppresses shortcuts; popups and the help take the mouse.
void route(const InputEvent& event, const Command& command, const Viewport& field,
           Controls& controls, GuiInput& gui);

}  // namespace pillarfield::viewer
