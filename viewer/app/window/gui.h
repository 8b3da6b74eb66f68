#pragma once

#include <string>

#include "viewer/app/input/shortcuts.h"
#include "viewer/app/window/screen.h"

namespace pillarfield::viewer {

/// Builds all of the window except the picture, in the current ImGui frame, between NewFrame() and
/// Render().
void draw_gui(const Command& command, const Screen& screen, const std::string& gpu);

}  // namespace pillarfield::viewer
