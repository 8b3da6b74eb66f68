#pragma once

#include "viewer/app/input/shortcuts.h"

namespace pillarfield::viewer {

/// What is shown and how: quantity, range, colours, layers, view, surface, theme.
void view_panel(const Command& command);

/// What can be written to files.
void write_panel(const Command& command);

}  // namespace pillarfield::viewer
