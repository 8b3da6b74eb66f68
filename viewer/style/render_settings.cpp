#include "viewer/style/render_settings.h"

#include <algorithm>

namespace pillarfield::viewer {

RenderSettings suited_to(const SourceInfo& source, RenderSettings settings) {
  if (source.skin.has_pillars()) return settings;
  settings.arrows = settings.sectors = settings.hatch = false;
  return settings;
}

Layout layout_of(double width, double height, const RenderSettings& settings) {
  if (!settings.legend) return {{0, 0, width, height}, {}, {}};
  const double unit = settings.scale;
  const double top = 34 * unit;
  const double bottom = 40 * unit;
  const double left = 58 * unit;
  const double right = (settings.colour_bar ? 24 + kColourBarWidth : 24) * unit;
  Layout layout;
  layout.plot = {left, top, std::max(width - left - right, 1.0),
                 std::max(height - top - bottom, 1.0)};
  const double bar_left = width - right + 24 * unit;
  const double bar_top = top + 26 * unit;
  const double bar_height = std::max(0.5 * layout.plot.height - 26 * unit, 1.0);
  layout.bar = {bar_left, bar_top, 18 * unit, bar_height};
  const double legend_top = bar_top + bar_height + 28 * unit;
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
