#pragma once

#include "pillarfield/contact_quantities.h"
#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"

namespace pillarfield::viewer {

// Actions of keys, mouse and panels. Each reports in `notice` what a user could miss.

/// Shows a quantity in its last range, at first fitted to the field on display; no effect where the
/// source lacks it.
void show_quantity(AppState& state, Quantity quantity);

/// Fits the range to the field on display.
void fit_range(AppState& state);

/// Sets the range, in the unit of the value; corrects `low` where the order is wrong or the range
/// of a diverging quantity is not symmetric.
void set_range(AppState& state, Range range);

/// Switches between top view and 3-D; each keeps its position.
void show_orbit(AppState& state, const FieldPlace& place, bool orbit);
[[nodiscard]] bool shows_orbit(const RenderSettings& settings);

/// Switches finding and marking contacts.
void show_contacts(AppState& state, bool shown);

/// Fits the view to the whole skin.
void reset_view(AppState& state, const FieldPlace& place);

/// Ends zooming out at the whole skin.
void stop_at_skin(AppState& state, const FieldPlace& place);

/// Pins or unpins a pillar.
void toggle_pin(AppState& state, PillarIndex pillar);
/// Moves the view if a contact's centre of pressure is out of sight.
void show_contact(AppState& state, const FieldPlace& place, const PatchPlace& centre);

/// Changes the speed by `steps` in the series 1, 2, 5, 10.
void change_speed(AppState& state, int steps);

/// Displays a new field.
void take_field(AppState& state, ShownField field);

}  // namespace pillarfield::viewer
