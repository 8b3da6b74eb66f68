#pragma once

#include <string>

#include "viewer/app/screen.h"
#include "viewer/app/shortcuts.h"

namespace pillarfield::viewer {

/// Everything of the window that is not the picture, as one frame of the current context of ImGui:
/// NewFrame() was called, Render() follows.
void draw_front(const Command& command, const Screen& screen, const std::string& gpu);

}  // namespace pillarfield::viewer
