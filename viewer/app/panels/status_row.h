#pragma once

#include <string>

#include "viewer/app/app_state.h"

namespace pillarfield::viewer {

/// What was measured, in one row of columns that stay where they are, and at its end the last
/// notice or, without one, who solves and who draws. Fills the current window of ImGui.
void status_row(const AppState& state, const std::string& gpu);

}  // namespace pillarfield::viewer
