#pragma once

#include "viewer/app/input/shortcuts.h"

namespace pillarfield::viewer {

/// Controls of the play head in one row: play, step, position, speed, loop, follow. Fills the
/// current ImGui window.
void transport(const Command& command);

}  // namespace pillarfield::viewer
