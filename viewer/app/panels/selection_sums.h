#pragma once

#include "viewer/app/app_state.h"

namespace pillarfield::viewer {

/// Sums over the selection in the field on display; both must exist. Cached per frame and
/// rectangle, since a square metre takes milliseconds.
[[nodiscard]] const SelectionSums& selection_sums(AppState& state);

}  // namespace pillarfield::viewer
