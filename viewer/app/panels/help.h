#pragma once

#include "viewer/app/window/screen.h"

namespace pillarfield::viewer {

/// Draws the help on keys and mouse over the field.
void help_overlay(const Viewport& area);

}  // namespace pillarfield::viewer
