#pragma once

#include <cstdint>
#include <string>

#include "viewer/app/input/shortcuts.h"

namespace pillarfield::viewer {

/// Parts of the window, in whole pixels. A side that is not shown has width or height 0.
struct Screen {
  Viewport field;      ///< the picture
  Viewport column;     ///< panels, at the right
  Viewport row;        ///< curves, below the play head or beside the field
  Viewport transport;  ///< the play head, below the field
  Viewport status;     ///< one line at the bottom
};

/// Sides that are shown. Curves take the room that the picture of the whole skin leaves, beside it
/// where that is wide.
struct Sides {
  bool column = false;
  double row = 0;     ///< least height of the curves, nominal pixels; 0: none
  double aspect = 0;  ///< width over height of the skin; 0: not known
};
[[nodiscard]] Sides sides_of(const AppState& state);

/// Divides `width` x `height` pixels; the field has at least one pixel.
[[nodiscard]] Screen divide(std::uint32_t width, std::uint32_t height, double scale,
                            const Sides& sides);

/// Flags of a fixed part of the window.
[[nodiscard]] int fixed_window_flags();

/// Draws the panels that have something to show into the current ImGui window.
void draw_panels(const Command& command);

/// Builds all of the window except the picture, in the current ImGui frame, between NewFrame() and
/// Render().
void draw_gui(const Command& command, const Screen& screen, const std::string& gpu);

}  // namespace pillarfield::viewer
