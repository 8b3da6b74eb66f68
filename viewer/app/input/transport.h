#pragma once

#include "viewer/app/input/shortcuts.h"

namespace pillarfield::viewer {

/// The play head in one row: play, step, where it is, how fast, loop, follow. Fills the current
/// window of ImGui.
void transport(const Command& command);

}  // namespace pillarfield::viewer
