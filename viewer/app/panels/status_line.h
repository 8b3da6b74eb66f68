#pragma once

#include "pillarfield/status.h"
#include "viewer/app/app_state.h"
#include "viewer/app/panels/panel_style.h"

namespace pillarfield::viewer {

[[nodiscard]] Colour region_colour(Region region, Theme theme);

/// A pillar's status after a swatch in the colour of its region or fault; "no sensel" for one that
/// has none.
void status_line(const PanelStyle& style, const AppState& state, PillarIndex pillar,
                 std::uint8_t status);

/// A swatch of a digit's height; the next item follows on the same line.
void swatch(const PanelStyle& style, ImU32 colour);

}  // namespace pillarfield::viewer
