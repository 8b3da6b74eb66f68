#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/plot.h"
#include "viewer/source/curves.h"

namespace pillarfield::viewer {

/// Possible directions of a force, degrees; phi may exceed 180.
struct DirectionBox {
  Span phi;
  Span theta;
};

/// The interval of an ambiguous pillar, else one standard deviation to either side; none without
/// uncertainty or for an idle pillar.
[[nodiscard]] std::optional<DirectionBox> direction_box(const PillarValues& values);

/// The paper's Figure 4: feasible (phi, theta), degrees, of a pillar in region 3; empty in other
/// regions. Readings follow from the force by the model (2), since only their ratio matters.
[[nodiscard]] std::vector<Vec2> contour_of(const PillarValues& values);

/// Directions (phi, theta), degrees, of the points of a curve, split where phi wraps; without
/// points of zero force.
[[nodiscard]] std::vector<std::vector<Vec2>> trail_of(std::span<const CurvePoint> points);

/// Borders of the regions at phi (degrees): theta (degrees) up to which four and three sensels are
/// usable, and the sensels (1..4) that become inactive there.
struct RegionLimits {
  double four = 90, three = 90;
  int first = 0, second = 0;
};
[[nodiscard]] RegionLimits region_limits(double phi);

/// "3.12": section of the diagram in the paper's numbering, region and unusable sensels. Empty for
/// idle pillars and opposite sensels.
[[nodiscard]] std::string section_name(std::uint8_t status);

/// Draws the paper's Figure 3 with a pillar in it, and its directions before.
void draw_region_plot(ImDrawList& list, const Viewport& outer, const PillarValues& values,
                      std::span<const CurvePoint> before, const PanelStyle& style, ImU32 colour,
                      Theme theme);

}  // namespace pillarfield::viewer
