#pragma once

#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"

namespace pillarfield::viewer {

// The panels of the window, each drawn with Dear ImGui into the current window of ImGui, as wide as
// that is. Sizes follow RenderSettings::scale and the font.

/// The exact values under the cursor: one compact block; says so where there is no pillar.
void hover_panel(const AppState& state);

/// The inspected pillar, the paper's testbed interface (its Figure 7): four readings as bars,
/// theta, phi, magnitude with uncertainty, the region diagram (Figure 3) with the live point, its
/// uncertainty and, in region 3, the contour of Figure 4. Pins can be chosen and removed here.
void pillar_panel(AppState& state);

/// The marked region: total force, centre of pressure, area, peak, mean, shares of the regions.
void selection_panel(AppState& state);

/// The contacts of the field on display, heaviest first, and all of them together; one that is
/// clicked becomes the marked region. Says so where they are not looked for.
void contacts_panel(AppState& state, const FieldPlace& place);

/// Force over time of pinned pillars and the marked region, with the play head.
void time_panel(AppState& state);

}  // namespace pillarfield::viewer
