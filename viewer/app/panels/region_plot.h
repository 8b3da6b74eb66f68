#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/plot.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// Directions that a pillar's force may have, degrees; phi may reach beyond 180.
struct DirectionBox {
  Span phi;
  Span theta;
};

/// Of an ambiguous pillar from end to end, of others a standard deviation to either side; none
/// where that is not known, or the pillar is idle.
[[nodiscard]] std::optional<DirectionBox> direction_box(const PillarValues& values);

/// The paper's Figure 4: (phi, theta) in degrees that the two usable readings of a pillar in region
/// 3 leave possible; empty in other regions. The readings are those that the model (2) has for the
/// force, in newtons: the contour depends on their ratio alone.
[[nodiscard]] std::vector<Vec2> contour_of(const PillarValues& values);

/// Directions (phi, theta) in degrees of the last points of a history, in pieces that nowhere leap
/// from one edge of the diagram to the other. Points without a force are left out.
[[nodiscard]] std::vector<std::vector<Vec2>> trail_of(const History& history, std::size_t points);

/// The borders of the regions above phi (degrees): theta (degrees) up to which four sensels are
/// usable, and three; and the sensels (1..4) that lift there.
struct RegionLimits {
  double four = 90, three = 90;
  int first = 0, second = 0;
};
[[nodiscard]] RegionLimits region_limits(double phi);

/// "3.12": the section of the diagram that the usable sensels tell, as the paper numbers them, by
/// region and the sensels that are not usable. Empty for idle pillars and opposite sensels.
[[nodiscard]] std::string section_name(std::uint8_t status);

/// The paper's Figure 3 with a pillar in it.
void draw_region_plot(ImDrawList& list, const Viewport& outer, const PillarValues& values,
                      const History& history, const PanelStyle& style, ImU32 colour, Theme theme);

}  // namespace pillarfield::viewer
