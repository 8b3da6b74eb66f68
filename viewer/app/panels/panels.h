#pragma once

#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"
#include "viewer/app/input/shortcuts.h"

namespace pillarfield::viewer {

// The panels of the window, drawn into the current ImGui window at its width. Sizes follow
// RenderSettings::scale and the font.

/// Values of the pillar under the cursor.
void hover_panel(const AppState& state);

/// The inspected pillar, after the paper's testbed interface (Figure 7): readings as bars; theta,
/// phi and magnitude with uncertainty; the region diagram (Figure 3) with the current point, its
/// uncertainty and, in region 3, the contour of Figure 4. Selects and removes pins.
void pillar_panel(AppState& state);

/// The selection: total force, centre of pressure, area, peak, mean, shares of the regions.
void selection_panel(AppState& state);

/// The contacts of the field on display, heaviest first, and their total. A click selects the
/// extent of a contact.
void contacts_panel(AppState& state, const FieldPlace& place);

/// Total force, torque and centre of pressure of the whole skin over time, and the force on pinned
/// pillars and the selection. The wheel zooms, a drag pans, a click seeks.
void time_panel(AppState& state);

/// A sensor: record and tare, rate, losses, faulty sensels.
void sensor_panel(const Command& command);

/// After this time without a frame the window says so.
inline constexpr double kSilentSeconds = 1;

/// "no frames for 3 s".
[[nodiscard]] std::string silent_words(const LiveStatus& status);

}  // namespace pillarfield::viewer
