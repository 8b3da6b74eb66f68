#include "viewer/style/render_settings.h"

#include <algorithm>

namespace pillarfield::viewer {

RenderSettings suited_to(const SourceInfo& source, RenderSettings settings) {
  if (source.skin.has_pillars()) return settings;
  settings.arrows = settings.sectors = settings.hatch = false;
  return settings;
}

Layout layout_of(double width, double height, const RenderSettings& settings) {
  if (!settings.legend) return {{0, 0, width, height}, {0, 0, width, height}, {}, {}};
  constexpr double kLegendWidth = 134;
  const double unit = settings.scale;
  const double top = 8 * unit;
  const double bottom = 26 * unit;
  const double left = 50 * unit;
  const double right = 10 * unit;
  Layout layout;
  layout.plot = {left, top, std::max(width - left - right, 1.0),
                 std::max(height - top - bottom, 1.0)};
  layout.clear = layout.plot;
  layout.clear.width = std::max(layout.plot.width - kLegendWidth * unit, 1.0);
  const double bar_left = layout.clear.x + layout.clear.width + 6 * unit;
  const double bar_top = top + 36 * unit;
  // Letters of the legend take 215 pixels.
  const double bar_height =
      std::clamp(layout.plot.height - 260 * unit, 0.3 * layout.plot.height, 300 * unit);
  layout.bar = {bar_left, bar_top, 18 * unit, bar_height};
  const double legend_top = bar_top + bar_height + 20 * unit;
  layout.legend = {bar_left, legend_top, std::max(width - bar_left, 1.0),
                   std::max(height - bottom - legend_top, 1.0)};
  return layout;
}

TopView fitted_top(const SkinSize& skin, const Layout& layout) {
  TopView view = fit_top(skin, layout.clear);
  // In the middle of the plot, or as far to the left as the legend asks for.
  const double margin = 0.04 * layout.clear.width;
  const double right = 0.5 * (layout.plot.width + skin.width_mm * view.pixels_per_mm) + margin;
  view.centre_mm.x = std::max(right - layout.clear.width, 0.0) / view.pixels_per_mm;
  return view;
}

OrbitView fitted_orbit(const SkinSize& skin, const Surface& surface, const Layout& layout,
                       const OrbitView& angles) {
  Viewport middle = layout.plot;
  middle.width = std::max(2 * layout.clear.width - layout.plot.width, 0.5 * layout.plot.width);
  return fit_orbit(skin, surface, middle, angles);
}

std::uint32_t arrow_block(double pixels_per_pillar, double least_pixels) {
  std::uint32_t power = 1;
  while (power < (1u << 20)) {
    if (pixels_per_pillar * power >= least_pixels) return power;
    if (power > 1 && pixels_per_pillar * power * 1.5 >= least_pixels) return power / 2 * 3;
    power *= 2;
  }
  return power;
}

}  // namespace pillarfield::viewer
