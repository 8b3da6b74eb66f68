#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "viewer/style/ticks.h"
#include "viewer/style/view.h"

struct ImDrawList;

namespace pillarfield::viewer {

struct PanelStyle;

/// A stretch of values, from < to.
struct Span {
  double from = 0;
  double to = 1;
};

/// Where the values of a plot lie: x to the right and y upwards in `box`, pixels.
struct PlotArea {
  Viewport box;
  Span x;
  Span y;
  [[nodiscard]] Vec2 at(Vec2 value) const;        ///< pixels of a value
  [[nodiscard]] Vec2 value_at(Vec2 pixel) const;  ///< and back
};

/// The stretch from zero that holds all values that are numbers, with round ends so that at least
/// three ticks() lie in it; [0, 1] where there is nothing but zero.
[[nodiscard]] Span round_span(std::span<const double> values);

/// A curve in ascending x in pixels, with no more points than can be seen: of each column of pixels
/// the first, the lowest, the highest and the last one. What is no number is left out.
[[nodiscard]] std::vector<Vec2> thinned(std::span<const Vec2> curve, const PlotArea& area);

/// Widths in pixels, whole, in proportion to the counts and together `width`: each count above zero
/// has one pixel at least where there are enough. Zeros everywhere where all counts are zero.
[[nodiscard]] std::vector<int> shares_of(std::span<const std::uint64_t> counts, int width);

/// Ticks of both axes of a plot.
struct PlotTicks {
  std::vector<Tick> x;
  std::vector<Tick> y;
};

/// As many as there is room for.
[[nodiscard]] PlotTicks ticks_of(const PlotArea& area, const PanelStyle& style);

/// The part of `outer` that is left for the values once the ticks' labels have their place.
[[nodiscard]] Viewport inside_axes(const Viewport& outer, double label_width,
                                   const PanelStyle& style);

/// Ground, grid lines and labels left of and below the box.
void draw_axes(ImDrawList& list, const PlotArea& area, const PlotTicks& ticks,
               const PanelStyle& style);

void draw_curve(ImDrawList& list, const PlotArea& area, std::span<const Vec2> curve,
                std::uint32_t colour, double width);

/// The play head: a line at x.
void draw_head(ImDrawList& list, const PlotArea& area, double x, const PanelStyle& style);

}  // namespace pillarfield::viewer
