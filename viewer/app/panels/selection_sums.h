#pragma once

#include "viewer/app/app_state.h"

namespace pillarfield::viewer {

/// What the marked region of the field on display adds up to. Added up once a frame and rectangle
/// (milliseconds where the region is a square metre), and kept in the session. There must be both
/// a region and a field.
[[nodiscard]] const SelectionSums& selection_sums(AppState& state);

}  // namespace pillarfield::viewer
