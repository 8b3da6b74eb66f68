#pragma once

#include "viewer/app/app_state.h"
#include "viewer/style/colour_map.h"

namespace pillarfield::viewer {

/// Gives those pins that have none the least number that is free: a pin keeps its number, and with
/// it its colour, while others come and go.
void number_pins(AppState& state);

/// The pin becomes the inspected one; the others keep their order.
void inspect_pin(AppState& state, std::size_t index);

void remove_pin(AppState& state, std::size_t index);

/// The colour of what belongs to a pin, by its number: legible on the theme's ground, and told
/// apart from the others by the colour-blind. Number 0 has that of number 1.
[[nodiscard]] Colour pin_colour(int number, Theme theme);

}  // namespace pillarfield::viewer
