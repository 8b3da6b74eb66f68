#include "viewer/app/panels/plot.h"

#include <algorithm>
#include <cmath>

#include "viewer/app/panels/panel_style.h"

namespace pillarfield::viewer {
namespace {

double share_in(const Span& span, double value) {
  return (value - span.from) / (span.to - span.from);
}

/// Points of a curve in a column of pixels.
struct ColumnOfPixels {
  std::size_t first, lowest, highest, last;
};

void append(std::vector<Vec2>& points, std::span<const Vec2> curve, const ColumnOfPixels& column) {
  const std::size_t earlier = std::min(column.lowest, column.highest);
  const std::size_t later = std::max(column.lowest, column.highest);
  std::size_t before = curve.size();
  for (const std::size_t index : {column.first, earlier, later, column.last}) {
    if (index != before) points.push_back(curve[index]);
    before = index;
  }
}

}  // namespace

Vec2 PlotArea::at(Vec2 value) const {
  return {box.x + box.width * share_in(x, value.x),
          box.y + box.height * (1 - share_in(y, value.y))};
}

Vec2 PlotArea::value_at(Vec2 pixel) const {
  return {x.from + (x.to - x.from) * (pixel.x - box.x) / box.width,
          y.to - (y.to - y.from) * (pixel.y - box.y) / box.height};
}

Span round_span(std::span<const double> values, double rounding) {
  double low = 0;
  double high = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (std::max(high, -low) <= rounding) return {0, 1};
  const double step = nice_ceiling((high - low) / 5);
  return {step * std::floor(low / step), step * std::ceil(high / step)};
}

std::vector<std::span<const Vec2>> pieces_of(std::span<const Vec2> curve) {
  std::vector<std::span<const Vec2>> pieces;
  const auto is_finite = [](const Vec2& value) { return std::isfinite(value.y); };
  for (auto begin = curve.begin(); begin != curve.end();) {
    begin = std::find_if(begin, curve.end(), is_finite);
    const auto end = std::find_if_not(begin, curve.end(), is_finite);
    if (begin != end) pieces.emplace_back(begin, end);
    begin = end;
  }
  return pieces;
}

std::vector<Vec2> thinned(std::span<const Vec2> curve, const PlotArea& area) {
  std::vector<Vec2> pixels;
  for (const Vec2& value : curve) pixels.push_back(area.at(value));
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < pixels.size();) {
    const double left = std::floor(pixels[i].x);
    ColumnOfPixels column{i, i, i, i};
    for (; i < pixels.size() && pixels[i].x < left + 1; ++i) {
      if (pixels[i].y > pixels[column.lowest].y) column.lowest = i;
      if (pixels[i].y < pixels[column.highest].y) column.highest = i;
      column.last = i;
    }
    append(points, pixels, column);
  }
  return points;
}

PlotTicks ticks_of(const PlotArea& area, const PanelStyle& style) {
  const int most_x = std::max(static_cast<int>(area.box.width / (64 * style.unit)), 2);
  const int most_y = std::max(static_cast<int>(area.box.height / (1.2 * style.line)), 3);
  return {ticks(area.x.from, area.x.to, most_x), ticks(area.y.from, area.y.to, most_y)};
}

Viewport inside_axes(const Viewport& outer, double label_width, const PanelStyle& style) {
  const double left = std::ceil(label_width + 6 * style.unit);
  const double top = std::ceil(0.5 * style.line);
  const double bottom = std::ceil(style.line + 4 * style.unit);
  // Half of the last x label lies outside the plot.
  const double right = std::ceil(12 * style.unit);
  return {outer.x + left, outer.y + top, std::max(outer.width - left - right, 1.0),
          std::max(outer.height - top - bottom, 1.0)};
}

void draw_axes(ImDrawList& list, const PlotArea& area, const PlotTicks& ticks,
               const PanelStyle& style) {
  const Viewport& box = area.box;
  const double hair = std::max(std::round(style.unit), 1.0);
  draw_block(list, box, style.raised);
  for (const Tick& tick : ticks.y) {
    const Vec2 place = area.at({area.x.from, tick.value});
    draw_block(list, {box.x, place.y - 0.5 * hair, box.width, hair},
               tick.value == 0 ? mixed(style.grid, style.text, 0.25) : style.grid);
    draw_text(list, {box.x - 6 * style.unit, place.y - 0.5 * style.line}, style.faint, tick.label,
              Align::right);
  }
  for (const Tick& tick : ticks.x) {
    const Vec2 place = area.at({tick.value, area.y.from});
    draw_block(list, {place.x - 0.5 * hair, box.y, hair, box.height}, style.grid);
    draw_text(list, {place.x, box.y + box.height + 3 * style.unit}, style.faint, tick.label,
              Align::middle);
  }
}

void draw_curve(ImDrawList& list, const PlotArea& area, std::span<const Vec2> curve,
                std::uint32_t colour, double width) {
  const Viewport& box = area.box;
  list.PushClipRect(to_imgui({box.x, box.y - width}),
                    to_imgui({box.x + box.width, box.y + box.height + width}), true);
  for (const std::span<const Vec2> piece : pieces_of(curve)) {
    std::vector<ImVec2> points;
    for (const Vec2& pixel : thinned(piece, area)) points.push_back(to_imgui(pixel));
    list.AddPolyline(points.data(), static_cast<int>(points.size()), colour, ImDrawFlags_None,
                     static_cast<float>(width));
  }
  list.PopClipRect();
}

void draw_head(ImDrawList& list, const PlotArea& area, double x, const PanelStyle& style) {
  const double hair = std::max(std::round(style.unit), 1.0);
  const Vec2 top = area.at({x, area.y.to});
  draw_block(list, {top.x - 0.5 * hair, area.box.y, hair, area.box.height}, style.text);
  const double side = 4 * style.unit;
  list.AddTriangleFilled(to_imgui({top.x - side, area.box.y - side}),
                         to_imgui({top.x + side, area.box.y - side}),
                         to_imgui({top.x, area.box.y + 0.5 * side}), style.text);
}

namespace {

Span last_of(const Span& whole, double seconds) {
  return {std::max(whole.from, whole.to - seconds), whole.to};
}

}  // namespace

Span TimeWindow::of(const Span& whole, double lasts_s) const {
  const bool live = lasts_s > 0;
  if (!chosen_) return live ? last_of(whole, lasts_s) : whole;
  if (live && at_end_) return last_of(whole, chosen_->to - chosen_->from);
  return *chosen_;
}

void TimeWindow::zoom(const Span& whole, double lasts_s, double at_s, double factor) {
  const Span now = of(whole, lasts_s);
  const double length = std::max((now.to - now.from) / factor, kLeastSeconds);
  if (length >= whole.to - whole.from) {
    if (lasts_s > 0) {
      choose(whole, whole.from, whole.to - whole.from);
    } else {
      reset();
    }
    return;
  }
  const double share = (at_s - now.from) / (now.to - now.from);
  choose(whole, at_s - share * length, length);
}

void TimeWindow::pan(const Span& whole, double lasts_s, double seconds) {
  const Span now = of(whole, lasts_s);
  choose(whole, now.from + seconds, now.to - now.from);
}

void TimeWindow::choose(const Span& whole, double from, double length) {
  constexpr double kAtEnd = 1e-3;
  const double latest = std::max(whole.to - length, whole.from);
  from = std::clamp(from, whole.from, latest);
  chosen_ = Span{from, from + length};
  at_end_ = from >= latest - kAtEnd * length;
}

}  // namespace pillarfield::viewer
