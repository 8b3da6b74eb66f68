#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "viewer/style/ticks.h"
#include "viewer/style/view.h"

struct ImDrawList;

namespace pillarfield::viewer {

struct PanelStyle;

/// An interval of values, from < to.
struct Span {
  double from = 0;
  double to = 1;
};

/// The part of the curves on display: chosen by zooming and panning within the whole.
class TimeWindow {
 public:
  /// Shortest part, s.
  static constexpr double kLeastSeconds = 1e-3;

  /// The part of `whole` to show: all of it, or the part chosen; of a sensor (`lasts_s` > 0) the
  /// last `lasts_s` seconds. A chosen part that reached the end of a sensor's curves follows it.
  [[nodiscard]] Span of(const Span& whole, double lasts_s) const;

  /// Shows a part of `whole`: `factor` above 1 enlarges about the time `at_s`.
  void zoom(const Span& whole, double lasts_s, double at_s, double factor);
  /// Moves the part by `seconds` within `whole`.
  void pan(const Span& whole, double lasts_s, double seconds);
  void reset() { chosen_.reset(); }
  [[nodiscard]] bool is_chosen() const { return chosen_.has_value(); }

 private:
  void choose(const Span& whole, double from, double length);

  std::optional<Span> chosen_;
  bool at_end_ = false;  ///< the part reaches the end of the whole
};

/// Maps values to pixels in `box`, x to the right and y upwards.
struct PlotArea {
  Viewport box;
  Span x;
  Span y;
  [[nodiscard]] Vec2 at(Vec2 value) const;        ///< pixel of a value
  [[nodiscard]] Vec2 value_at(Vec2 pixel) const;  ///< value of a pixel
};

/// Interval that contains 0 and all finite values, with round ends and at least three ticks();
/// [0, 1] where no value is above `rounding`.
[[nodiscard]] Span round_span(std::span<const double> values, double rounding = 0);

/// The stretches of a curve between values that are not finite, which break it.
[[nodiscard]] std::vector<std::span<const Vec2>> pieces_of(std::span<const Vec2> curve);

/// Thins a finite curve in ascending x, in pixels: keeps the first, lowest, highest and last point
/// of each pixel column.
[[nodiscard]] std::vector<Vec2> thinned(std::span<const Vec2> curve, const PlotArea& area);

/// Ticks of both axes of a plot.
struct PlotTicks {
  std::vector<Tick> x;
  std::vector<Tick> y;
};

/// Ticks at the density that fits.
[[nodiscard]] PlotTicks ticks_of(const PlotArea& area, const PanelStyle& style);

/// The part of `outer` inside the tick labels.
[[nodiscard]] Viewport inside_axes(const Viewport& outer, double label_width,
                                   const PanelStyle& style);

/// Draws background, grid lines and tick labels.
void draw_axes(ImDrawList& list, const PlotArea& area, const PlotTicks& ticks,
               const PanelStyle& style);

/// Draws the pieces of a curve.
void draw_curve(ImDrawList& list, const PlotArea& area, std::span<const Vec2> curve,
                std::uint32_t colour, double width);

/// Draws the play head, a line at x.
void draw_head(ImDrawList& list, const PlotArea& area, double x, const PanelStyle& style);

}  // namespace pillarfield::viewer
