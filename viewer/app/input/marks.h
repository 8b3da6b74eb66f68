#pragma once

#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"

namespace pillarfield::viewer {

/// Draws over the picture what is marked in it: numbered pins, the region, the pillar under the
/// cursor. No part of the picture: files do not have it.
void draw_marks(const AppState& state, const FieldPlace& place);

}  // namespace pillarfield::viewer
