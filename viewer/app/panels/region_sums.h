#pragma once

#include "viewer/app/session.h"

namespace pillarfield::viewer {

/// What the marked region of the field on display adds up to. Added up once a frame and rectangle
/// (milliseconds where the region is a square metre), and kept in the session. There must be both
/// a region and a field.
[[nodiscard]] const RegionSums& region_sums(Session& session);

}  // namespace pillarfield::viewer
