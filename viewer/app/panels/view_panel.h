#pragma once

#include "viewer/app/input/shortcuts.h"

namespace pillarfield::viewer {

/// Settings of the picture: quantity, range, colours, layers, view, surface, theme.
void view_panel(const Command& command);

/// Buttons that write files.
void write_panel(const Command& command);

}  // namespace pillarfield::viewer
