#pragma once

#include <string>

#include "viewer/app/input/shortcuts.h"
#include "viewer/app/window/panel_layout.h"

namespace pillarfield::viewer {

/// Draws all panels in their docks, and moves those that the user drags; the edges of docks can be
/// dragged too.
void draw_docks(const Command& command, const Screen& screen);

/// Begins a fixed part of the window, without decorations, and draws its upper and left edge;
/// ImGui::End() ends it. `flags`: further ImGuiWindowFlags.
void begin_part(const char* name, const Viewport& box, Theme theme, int flags = 0);

/// Flags of a fixed part of the window.
[[nodiscard]] int fixed_window_flags();

/// Builds all of the window except the picture, in the current ImGui frame, between NewFrame() and
/// Render().
void draw_gui(const Command& command, const Screen& screen, const std::string& gpu);

}  // namespace pillarfield::viewer
