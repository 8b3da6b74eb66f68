#pragma once

#include <string>

#include "viewer/app/input/shortcuts.h"
#include "viewer/app/window/screen.h"

namespace pillarfield::viewer {

/// Everything of the window that is not the picture, as one frame of the current context of ImGui:
/// NewFrame() was called, Render() follows.
void draw_gui(const Command& command, const Screen& screen, const std::string& gpu);

}  // namespace pillarfield::viewer
