#pragma once

#include "pillarfield/status.h"
#include "viewer/app/panels/panel_style.h"

namespace pillarfield::viewer {

[[nodiscard]] Colour region_colour(Region region, Theme theme);

/// What a pillar's status says, behind a swatch in the colour of its region or fault.
void status_line(const PanelStyle& style, std::uint8_t status, Theme theme);

/// A swatch as high as a digit; what follows stands in the same line.
void swatch(const PanelStyle& style, ImU32 colour);

}  // namespace pillarfield::viewer
