#pragma once

#include "pillarfield/status.h"
#include "viewer/app/panels/panel_ink.h"

namespace pillarfield::viewer {

[[nodiscard]] Colour region_colour(Region region, Theme theme);

/// What a pillar's status says, behind a swatch in the colour of its region or fault.
void status_line(const PanelInk& ink, std::uint8_t status, Theme theme);

/// A swatch as high as a digit; what follows stands in the same line.
void swatch(const PanelInk& ink, ImU32 colour);

}  // namespace pillarfield::viewer
