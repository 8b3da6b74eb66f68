#pragma once

#include "pillarfield/contact_quantities.h"
#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"

namespace pillarfield::viewer {

// What keys, mouse and panels do to a session; each says in `notice` what a user could miss.

/// Shows a quantity, in the range it was last looked at, at first what fits the field on display.
/// One that the source lacks stays unshown.
void show_quantity(AppState& state, Quantity quantity);

/// Fits the range to the field on display.
void fit_range(AppState& state);

/// A range set by hand, in the quantity's own unit. Ends in the wrong order or of a diverging
/// quantity that are not symmetric are made so about `high`.
void set_range(AppState& state, Range range);

/// Top view or 3-D. Each keeps where it was when the other was looked at.
void show_orbit(AppState& state, const FieldPlace& place, bool orbit);
[[nodiscard]] bool shows_orbit(const RenderSettings& settings);

/// Whether contacts are looked for and marked.
void show_contacts(AppState& state, bool shown);

/// The whole skin.
void reset_view(AppState& state, const FieldPlace& place);

/// Another surface; a 3-D view that nobody moved is fitted to it.
void set_surface(AppState& state, const FieldPlace& place, const Surface& surface);

/// Pins a pillar, or takes its pin away.
void toggle_pin(AppState& state, PillarIndex pillar);
void select_pillars(AppState& state, const PillarRect& rect);
/// Marks the pillars about a contact; where its centre of pressure is out of sight the view goes
/// there.
void mark_contact(AppState& state, const FieldPlace& place, const PatchPlace& centre,
                  const PillarRect& extent);
void clear_marks(AppState& state);

/// Plays so much faster (or slower, -1) in steps of 1, 2, 5, 10.
void change_speed(AppState& state, int steps);

/// A field has come: it is on display, and the histories of pins and region go on.
void take_field(AppState& state, ShownField field);

}  // namespace pillarfield::viewer
