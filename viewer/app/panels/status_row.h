#pragma once

#include <string>

#include "viewer/app/app_state.h"

namespace pillarfield::viewer {

/// Measurements in fixed columns and, at the end, the last notice or else solver and graphics
/// device. Fills the current ImGui window.
void status_row(const AppState& state, const std::string& gpu);

}  // namespace pillarfield::viewer
