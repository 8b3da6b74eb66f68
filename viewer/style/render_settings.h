#pragma once

#include <string>

#include "viewer/style/colour_map.h"
#include "viewer/style/quantity.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// Everything that a picture depends on except the field and the size.
struct RenderSettings {
  Quantity quantity = Quantity::normal;
  Units units;  ///< of numbers and scales
  Range range;  ///< ends of the colour bar in the unit of the value
  ColourMap map = ColourMap::cividis;
  Theme theme = Theme::dark;
  View view = TopView{};
  Surface surface;
  bool arrows = true;
  bool sectors = false;  ///< uncertainty sectors of ambiguous shear, once cells are single pillars
  bool hatch = true;     ///< hatch ambiguous pillars
  bool contacts = true;  ///< marks of contacts
  bool relief = false;   ///< in 3-D, the surface is raised by the normal force
  double relief_full_n = 1;  ///< normal force whose height is 12 % of the skin's shorter side
  /// Mean force per pillar whose arrow is 1.5 cells long; top views use the shear.
  double full_force_n = 1;
  double full_shear_n = 1;
  double arrow_cell = 14;  ///< least width of an arrow's cell, pixels at scale 1
  double scale = 1;        ///< pixels of the display per nominal pixel
  bool legend = true;      ///< axes, colour bar, legends and title
  std::string title;
  friend bool operator==(const RenderSettings&, const RenderSettings&) = default;
};

/// The settings without the layers that a source lacks: those of shear where there are no pillars.
[[nodiscard]] RenderSettings suited_to(const SourceInfo& source, RenderSettings settings);

/// Room around the plot of a picture, pixels.
struct Margins {
  double left = 0, top = 0, right = 0, bottom = 0;
  double legend = 0;  ///< further at the right, for colour bar and legend where they are shown
};
[[nodiscard]] Margins margins_of(const RenderSettings& settings);

/// Parts of a picture of `width` x `height` pixels.
struct Layout {
  Viewport plot;    ///< the skin
  Viewport bar;     ///< the colour bar, at the right of the plot
  Viewport legend;  ///< the meaning of colours and arrows, below the bar
};

[[nodiscard]] Layout layout_of(double width, double height, const RenderSettings& settings);

/// Pillars along an arrow's cell: the least of 1, 2, 3, 4, 6, 8, 12, 16, ... for which the cell is
/// at least `least_pixels` wide.
[[nodiscard]] std::uint32_t arrow_block(double pixels_per_pillar, double least_pixels);

}  // namespace pillarfield::viewer
