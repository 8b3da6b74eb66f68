#pragma once

#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"

namespace pillarfield::viewer {

/// Draws numbered pins, the selection and the pillar under the cursor over the picture; files do
/// not include them.
/// The trails of the centres of pressure are among them.
void draw_marks(const AppState& state, const FieldPlace& place);

/// The place of the second source, at the right of the first.
[[nodiscard]] FieldPlace beside_place(const AppState& state, const FieldPlace& place);

}  // namespace pillarfield::viewer
