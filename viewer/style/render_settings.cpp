#include "viewer/style/render_settings.h"

#include <algorithm>
#include <cmath>

namespace pillarfield::viewer {

RenderSettings suited_to(const SourceInfo& source, RenderSettings settings) {
  if (source.skin.has_pillars()) return settings;
  settings.arrows = settings.sectors = settings.hatch = false;
  return settings;
}

Margins margins_of(const RenderSettings& settings) {
  if (!settings.legend) return {};
  const double unit = settings.scale;
  return {50 * unit, 22 * unit, 10 * unit, 26 * unit, std::round(140 * unit)};
}

Layout layout_of(double width, double height, const RenderSettings& settings) {
  const auto [left, top, right, bottom, legend] = margins_of(settings);
  const double used = left + right + legend;
  Layout layout;
  layout.plot = {left, top, std::max(width - used, 1.0), std::max(height - top - bottom, 1.0)};
  const double unit = settings.scale;
  const double bar_left = left + layout.plot.width + 12 * unit;
  const double bar_top = top + 22 * unit;
  // Letters of the legend take 215 pixels.
  const double bar_height =
      std::clamp(layout.plot.height - 260 * unit, 0.3 * layout.plot.height, 300 * unit);
  layout.bar = {bar_left, bar_top, 18 * unit, bar_height};
  const double legend_top = bar_top + bar_height + 20 * unit;
  layout.legend = {bar_left, legend_top, std::max(width - bar_left, 1.0),
                   std::max(height - bottom - legend_top, 1.0)};
  return layout;
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
