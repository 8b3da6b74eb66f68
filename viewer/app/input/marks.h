#pragma once

#include "viewer/app/field_place.h"
#include "viewer/app/session.h"

namespace pillarfield::viewer {

/// Draws over the picture what is marked in it: numbered pins, the region, the pillar under the
/// cursor. No part of the picture: files do not have it.
void draw_marks(const Session& session, const FieldPlace& place);

}  // namespace pillarfield::viewer
