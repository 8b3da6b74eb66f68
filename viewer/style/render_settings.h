#pragma once

#include <string>

#include "viewer/style/colour_map.h"
#include "viewer/style/quantity.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// How a field is to look: everything that a picture depends on but the field and its size.
struct RenderSettings {
  Quantity quantity = Quantity::normal;
  Range range;  ///< ends of the colour bar, in the quantity's own unit
  ColourMap map = ColourMap::cividis;
  Theme theme = Theme::dark;
  View view = TopView{};
  Surface surface;
  bool arrows = true;
  bool sectors = false;   ///< what ambiguous shear may be, once a pillar has a cell of its own
  bool hatch = true;      ///< ambiguous pillars are hatched
  bool contacts = false;  ///< marks of contacts, where the field has them
  /// Mean force per pillar whose arrow is as long as its cell and a half; from above arrows are
  /// those of shear.
  double full_force_n = 1;
  double full_shear_n = 1;
  double arrow_cell = 14;  ///< least width of an arrow's cell, pixels at scale 1
  double scale = 1;        ///< pixels of the display over those the sizes here are meant for
  bool legend = true;      ///< axes, colour bar, legends and title
  std::string title;
  friend bool operator==(const RenderSettings&, const RenderSettings&) = default;
};

/// Where the parts of a picture of `width` x `height` pixels are.
struct Layout {
  Viewport plot;    ///< the skin
  Viewport bar;     ///< the colour bar
  Viewport legend;  ///< the meaning of colours and arrows
};
[[nodiscard]] Layout layout_of(double width, double height, const RenderSettings& settings);

/// Pillars along an arrow's cell: of 1, 2, 3, 4, 6, 8, 12, 16, ... the least that makes the cell so
/// many pixels wide.
[[nodiscard]] std::uint32_t arrow_block(double pixels_per_pillar, double least_pixels);

}  // namespace pillarfield::viewer
