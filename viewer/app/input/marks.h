#pragma once

#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"
#include "viewer/style/colour_map.h"

namespace pillarfield::viewer {

/// Draws numbered pins and the pillar under the cursor over the
/// picture; files do not include them.
void draw_marks(const AppState& state, const FieldPlace& place);

/// Gives each unnumbered pin the least free number; a pin keeps its number and colour.
void number_pins(Marks& marks);

/// Makes a pin the inspected one; the others keep their order.
void inspect_pin(Marks& marks, std::size_t index);

void remove_pin(Marks& marks, std::size_t index);

/// Colour of a pin by its number: legible in the theme, distinct for colour-blind readers; 0 has
/// the colour of 1.
[[nodiscard]] Colour pin_colour(int number, Theme theme);

}  // namespace pillarfield::viewer
