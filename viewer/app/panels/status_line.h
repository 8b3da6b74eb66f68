#pragma once

#include "pillarfield/status.h"
#include "viewer/app/panels/panel_style.h"

namespace pillarfield::viewer {

[[nodiscard]] Colour region_colour(Region region, Theme theme);

/// A pillar's status after a swatch in the colour of its region or fault.
void status_line(const PanelStyle& style, std::uint8_t status, Theme theme);

/// A swatch of a digit's height; the next item follows on the same line.
void swatch(const PanelStyle& style, ImU32 colour);

}  // namespace pillarfield::viewer
