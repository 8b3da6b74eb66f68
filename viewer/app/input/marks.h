#pragma once

#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"

namespace pillarfield::viewer {

/// Draws numbered pins, the selection and the pillar under the cursor over the picture; files do
/// not include them.
void draw_marks(const AppState& state, const FieldPlace& place);

}  // namespace pillarfield::viewer
