#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "viewer/app/input/pins.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/plot.h"
#include "viewer/app/panels/status_line.h"

namespace pillarfield::viewer {
namespace {

struct Curve {
  std::vector<Vec2> points;  ///< s, N
  ImU32 colour;
};

struct Chart {
  const char* title;
  std::vector<Curve> curves;
};

using Component = double (*)(const History::Point&);
double normal_of(const History::Point& point) { return static_cast<double>(point.normal); }
double shear_of(const History::Point& point) {
  return std::hypot(static_cast<double>(point.shear_x), static_cast<double>(point.shear_y));
}

std::vector<Vec2> curve_of(const History& history, Component component) {
  std::vector<Vec2> points;
  points.reserve(history.points().size());
  for (const History::Point& each : history.points()) {
    points.push_back({each.time_s, component(each)});
  }
  return points;
}

Chart chart_of_pins(const char* title, const AppState& state, Component component) {
  Chart chart{title, {}};
  for (const Pin& pin : state.pins) {
    chart.curves.push_back(
        {curve_of(pin.history, component), packed(pin_colour(pin.number, state.settings.theme))});
  }
  return chart;
}

/// The selection has its own charts, since it carries much more than a pillar.
std::vector<Chart> charts_of(const AppState& state, const PanelStyle& style) {
  std::vector<Chart> charts;
  if (!state.pins.empty()) {
    charts.push_back(chart_of_pins("Normal of the pins, N", state, normal_of));
    charts.push_back(chart_of_pins("|Shear| of the pins, N", state, shear_of));
  }
  if (state.selection) {
    const History& history = state.selection->history;
    charts.push_back({"Normal of the selection, N", {{curve_of(history, normal_of), style.text}}});
    charts.push_back({"|Shear| of the selection, N", {{curve_of(history, shear_of), style.text}}});
  }
  return charts;
}

/// Common time span of all curves, which aligns the play head.
Span time_span(const std::vector<Chart>& charts, double now_s) {
  Span span{now_s, now_s};
  for (const Chart& chart : charts) {
    for (const Curve& curve : chart.curves) {
      if (curve.points.empty()) continue;
      span.from = std::min(span.from, curve.points.front().x);
      span.to = std::max(span.to, curve.points.back().x);
    }
  }
  constexpr double kLeast = 0.1;
  if (span.to - span.from < kLeast) span.to = span.from + kLeast;
  return span;
}

Span force_span(const Chart& chart) {
  std::vector<double> values;
  for (const Curve& curve : chart.curves) {
    for (const Vec2& each : curve.points) values.push_back(each.y);
  }
  return round_span(values);
}

constexpr double kChartHeight = 116;

/// Widest y label of all charts, which aligns their axes.
double label_width(const std::vector<Chart>& charts, const PanelStyle& style) {
  double widest = 0;
  for (const Chart& chart : charts) {
    const PlotArea area{
        {0, 0, 1, kChartHeight * style.unit - 3 * style.line}, {}, force_span(chart)};
    for (const Tick& tick : ticks_of(area, style).y)
      widest = std::max(widest, width_of(tick.label));
  }
  return widest;
}

/// Common properties of all charts.
struct ChartFrame {
  Span time;
  double now_s = 0;
  double label_width = 0;
};

void draw_chart(const Chart& chart, const Viewport& outer, const ChartFrame& frame,
                const PanelStyle& style) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const double title = style.line + 2 * style.unit;
  const Viewport below{outer.x, outer.y + title, outer.width, outer.height - title};
  const PlotArea area{inside_axes(below, frame.label_width, style), frame.time, force_span(chart)};
  draw_text(list, {outer.x, outer.y}, style.text, chart.title);
  PlotTicks ticks = ticks_of(area, style);
  if (!ticks.x.empty()) ticks.x.back().label += " s";
  draw_axes(list, area, ticks, style);
  for (const Curve& curve : chart.curves) {
    draw_curve(list, area, curve.points, curve.colour, 1.6 * style.unit);
  }
  draw_head(list, area, frame.now_s, style);
}

void draw_legend(const AppState& state, const PanelStyle& style) {
  std::vector<const Pin*> pins;
  for (const Pin& pin : state.pins) pins.push_back(&pin);
  std::ranges::sort(pins, {}, [](const Pin* pin) { return pin->number; });
  const double right = static_cast<double>(ImGui::GetWindowContentRegionMax().x);
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const std::string words =
        fmt::format("{}  ({}, {})", pins[i]->number, pins[i]->pillar.row, pins[i]->pillar.col);
    if (i > 0) {
      ImGui::SameLine(0, static_cast<float>(16 * style.unit));
      const double end =
          static_cast<double>(ImGui::GetCursorPosX()) + width_of(words) + 2 * style.line;
      if (end > right) ImGui::NewLine();
    }
    swatch(style, packed(pin_colour(pins[i]->number, state.settings.theme)));
    ImGui::TextUnformatted(words.c_str());
  }
}

/// Charts in rows, as many per row as fit.
void draw_charts(const std::vector<Chart>& charts, const ChartFrame& frame,
                 const PanelStyle& style) {
  const double available = static_cast<double>(ImGui::GetContentRegionAvail().x);
  const double gap = 14 * style.unit;
  const auto fitting = static_cast<std::size_t>(std::max(available / (300 * style.unit), 1.0));
  const std::size_t beside =
      std::min(fitting >= 4 ? 4 : std::min<std::size_t>(fitting, 2), charts.size());
  const double width =
      (available - gap * static_cast<double>(beside - 1)) / static_cast<double>(beside);
  for (std::size_t i = 0; i < charts.size(); ++i) {
    if (i % beside != 0) ImGui::SameLine(0, static_cast<float>(gap));
    draw_chart(charts[i], reserve(width, kChartHeight * style.unit), frame, style);
  }
}

}  // namespace

void time_panel(AppState& state) {
  const PanelStyle style = panel_style(state.settings.scale);
  number_pins(state);
  const std::vector<Chart> charts = charts_of(state, style);
  if (charts.empty() || !state.field) {
    faint_text(style, "Pinned pillars and the selection show their forces over time here.");
    return;
  }
  const double now_s = state.field->time_s;
  draw_legend(state, style);
  draw_charts(charts, {time_span(charts, now_s), now_s, label_width(charts, style)}, style);
}

}  // namespace pillarfield::viewer
