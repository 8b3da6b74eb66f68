#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "viewer/app/input/controls.h"

namespace pillarfield::viewer {

/// Queues input events and passes them to Dear ImGui, which looks at keys and buttons once a frame:
/// a frame sees one press or release, and a click where it was made, however slowly frames follow.
class GuiInput {
 public:
  void add(const std::vector<InputEvent>& events);
  /// The next event of this frame; none: the rest, if any, waits for the next frame.
  [[nodiscard]] std::optional<InputEvent> next();
  [[nodiscard]] bool is_empty() const { return events_.empty(); }
  [[nodiscard]] bool has_pressed(int key) const;
  void clear() { events_.clear(); }

  static void take(const InputEvent& event);

  /// A text field has the keyboard.
  [[nodiscard]] static bool wants_text();
  /// Queries and closes popup lists.
  [[nodiscard]] static bool has_open_list();
  static void close_lists();

  /// Call it before each ImGui frame, with its context current.
  void begin_frame(double seconds_since_last);

 private:
  std::deque<InputEvent> events_;
  bool changed_ = false;  ///< a key or button, since the last frame
  bool moved_ = false;    ///< the mouse
  int held_ = 0;          ///< the key pressed last, which may repeat; 0: released
};

/// Sends an event to the controls of the field, which lies at `field`, or to Dear ImGui. Text input
/// suppresses shortcuts; popups and the help take the mouse.
void route(const InputEvent& event, const Command& command, const Viewport& field,
           Controls& controls);

}  // namespace pillarfield::viewer
