#pragma once

#include "viewer/app/window/screen.h"

namespace pillarfield::viewer {

/// All keys and what the mouse does, over the field.
void help_overlay(const Viewport& area);

}  // namespace pillarfield::viewer
