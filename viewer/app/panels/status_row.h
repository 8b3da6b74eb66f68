#pragma once

#include <string>

#include "viewer/app/session.h"

namespace pillarfield::viewer {

/// What was measured, in one row of columns that stay where they are, and at its end the last
/// notice or, without one, who solves and who draws. Fills the current window of ImGui.
void status_row(const Session& session, const std::string& gpu);

}  // namespace pillarfield::viewer
