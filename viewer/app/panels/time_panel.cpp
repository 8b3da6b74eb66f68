#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/plot.h"
#include "viewer/render/scene.h"

namespace pillarfield::viewer {
namespace {

constexpr double kLiveSeconds = 20;  ///< shown of a sensor at first
constexpr std::size_t kMostShownPoints = 8192;
constexpr double kChartHeight = 72;  ///< least, nominal pixels
constexpr double kChartWidth = 150;  ///< least beside others

using Points = std::vector<CurvePoint>;
using Component = double (*)(const CurvePoint&);

struct Curve {
  std::string name;
  Points points;
  Component value;
  ImU32 colour;
};

struct Chart {
  std::string title;
  Dimension dimension;
  std::vector<Curve> curves;
  double rounding = 0;  ///< values up to here are zero but for rounding
  Unit unit = {};

  /// In the unit of display.
  [[nodiscard]] double value(const Curve& curve, const CurvePoint& point) const {
    return unit.factor * curve.value(point);
  }
};

double normal_of(const CurvePoint& point) { return static_cast<double>(point.normal); }
double shear_x_of(const CurvePoint& point) { return static_cast<double>(point.shear_x); }
double shear_y_of(const CurvePoint& point) { return static_cast<double>(point.shear_y); }
double torque_of(const CurvePoint& point) { return static_cast<double>(point.torque); }
double centre_x_of(const CurvePoint& point) { return static_cast<double>(point.centre_x_mm); }
double centre_y_of(const CurvePoint& point) { return static_cast<double>(point.centre_y_mm); }

struct Colours {
  ImU32 x, y, normal;
};

Colours colours_of(const PanelStyle& style, Theme theme) {
  const bool dark = theme == Theme::dark;
  return {packed(colour_from(dark ? 0x56b4e9 : 0x0072b2)),
          packed(colour_from(dark ? 0xe69f00 : 0xb06000)), style.text};
}

/// Components of a force; without pillars only the normal one exists.
Chart force_chart(const char* title, const Points& points, const Colours& colours, bool pillars) {
  Chart chart{title, Dimension::force, {}};
  if (pillars) {
    chart.curves = {{"x", points, shear_x_of, colours.x}, {"y", points, shear_y_of, colours.y}};
  }
  chart.curves.push_back({"normal", points, normal_of, colours.normal});
  return chart;
}

/// Total force, torque and centre of pressure of the whole skin.
void add_total(std::vector<Chart>& charts, const Points& points, const Colours& colours,
               bool pillars) {
  charts.push_back(force_chart("Force", points, colours, pillars));
  if (pillars) {
    charts.push_back({"Torque", Dimension::torque, {{"", points, torque_of, colours.normal}}});
  }
  charts.push_back(
      {"Centre of pressure",
       Dimension::length,
       {{"x", points, centre_x_of, colours.x}, {"y", points, centre_y_of, colours.y}}});
}

/// Forces are sums in single precision, torques those times a length.
void set_rounding(std::vector<Chart>& charts, const SourceInfo& source) {
  constexpr double kRounding = 1e-6;
  double most_n = 0;
  for (const CurvePoint& point : charts.front().curves.front().points) {
    most_n = std::max(most_n, std::abs(normal_of(point)));
  }
  const SkinSize size = skin_size(source);
  const double length_mm = std::max(size.width_mm, size.height_mm);
  for (Chart& chart : charts) {
    const bool force = chart.dimension == Dimension::force;
    const bool torque = chart.dimension == Dimension::torque;
    chart.rounding = kRounding * (force ? most_n : torque ? most_n * length_mm : length_mm);
  }
}

std::vector<Chart> charts_of(const AppState& state, const Span& time, const PanelStyle& style) {
  const Colours colours = colours_of(style, state.look.settings.theme);
  const bool pillars = state.source.player->info().skin.has_pillars();
  std::vector<Chart> charts;
  add_total(charts, state.source.curves->between(time.from, time.to, kMostShownPoints), colours,
            pillars);
  set_rounding(charts, state.source.player->info());
  for (Chart& chart : charts) chart.unit = state.look.settings.units.of(chart.dimension);
  return charts;
}

/// Times and values of a curve, with NaN in each gap.
std::vector<Vec2> places_of(const Chart& chart, const Curve& curve, std::span<const Span> gaps) {
  std::vector<Vec2> places;
  places.reserve(curve.points.size() + gaps.size());
  auto gap = gaps.begin();
  for (const CurvePoint& point : curve.points) {
    for (; gap != gaps.end() && gap->from < point.time_s; ++gap) {
      places.push_back({gap->from, std::numeric_limits<double>::quiet_NaN()});
    }
    places.push_back({point.time_s, chart.value(curve, point)});
  }
  return places;
}

Span value_span(const Chart& chart) {
  std::vector<double> values;
  for (const Curve& curve : chart.curves) {
    for (const CurvePoint& point : curve.points) values.push_back(chart.value(curve, point));
  }
  return round_span(values, chart.unit.factor * chart.rounding);
}

/// The point nearest in time; null without points.
const CurvePoint* nearest(const Points& points, double time_s) {
  const auto after = std::ranges::lower_bound(points, time_s, {}, &CurvePoint::time_s);
  if (points.empty()) return nullptr;
  if (after == points.begin()) return &points.front();
  if (after == points.end()) return &points.back();
  return time_s - (after - 1)->time_s < after->time_s - time_s ? &*(after - 1) : &*after;
}

/// Common properties of all charts.
struct ChartFrame {
  AppState& state;
  Span whole;
  Span time;
  double lasts_s = 0;
  double label_width = 0;
  std::vector<Span> gaps;  ///< of time without frames
};

/// Stretches of time in which a sensor sent nothing, the last of them up to now.
std::vector<Span> gaps_of(const Points& points, double now_s) {
  std::vector<Span> gaps;
  if (points.empty()) return gaps;
  const double apart_s =
      (points.back().time_s - points.front().time_s) / static_cast<double>(points.size());
  const double least_s = std::max(kSilentSeconds, 4 * apart_s);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double from = points[i].time_s;
    const double to = i + 1 < points.size() ? points[i + 1].time_s : now_s;
    if (to - from > least_s) gaps.push_back({from, to});
  }
  return gaps;
}

/// Exact values of a frame.
void show_values(const Chart& chart, double time_s, const Units& units) {
  const CurvePoint* const at = nearest(chart.curves.front().points, time_s);
  if (at == nullptr) return;
  std::string words =
      fmt::format("frame {}   {}", at->index + 1, units.fixed(Dimension::time, at->time_s, 4));
  for (const Curve& curve : chart.curves) {
    const CurvePoint* const point = nearest(curve.points, time_s);
    if (point == nullptr) continue;
    words += fmt::format("\n{}{}{:.6g} {}", curve.name, curve.name.empty() ? "" : "  ",
                         chart.value(curve, *point), chart.unit.name);
  }
  ImGui::SetTooltip("%s", words.c_str());
}

/// Wheel zooms, drag pans, click seeks, double click shows the whole.
void take_mouse(const Chart& chart, const PlotArea& area, const ChartFrame& frame,
                const PanelStyle& style) {
  const ImGuiIO& io = ImGui::GetIO();
  const double at_s = area.value_at({static_cast<double>(io.MousePos.x), area.box.y}).x;
  TimeWindow& window = frame.state.look.time_window;
  const double per_pixel = (area.x.to - area.x.from) / area.box.width;
  if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 3)) {
    window.pan(frame.whole, frame.lasts_s, -per_pixel * static_cast<double>(io.MouseDelta.x));
    return;
  }
  if (!ImGui::IsItemHovered()) return;
  ImGui::SetItemUsingMouseWheel();
  constexpr double kZoomOfNotch = 1.25;
  if (io.MouseWheel != 0) {
    const double factor = std::pow(kZoomOfNotch, static_cast<double>(io.MouseWheel));
    window.zoom(frame.whole, frame.lasts_s, at_s, factor);
  }
  const CurvePoint* const point = nearest(chart.curves.front().points, at_s);
  if (point == nullptr) return;
  draw_block(*ImGui::GetWindowDrawList(),
             {area.at({point->time_s, 0}).x, area.box.y, 1, area.box.height}, style.faint);
  show_values(chart, at_s, frame.state.look.settings.units);
  if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
    window.reset();
  } else if (ImGui::IsMouseReleased(ImGuiMouseButton_Left) &&
             !ImGui::IsMouseDragPastThreshold(ImGuiMouseButton_Left, 3)) {
    frame.state.source.player->seek(point->index);
  }
}

/// Title, unit and the names of the curves in their colours.
void draw_title(ImDrawList& list, const Chart& chart, const Viewport& outer,
                const PanelStyle& style) {
  const std::string title = fmt::format("{}, {}", chart.title, chart.unit.name);
  draw_text(list, {outer.x, outer.y}, style.faint, title);
  double x = outer.x + width_of(title) + 12 * style.unit;
  for (const Curve& curve : chart.curves) {
    draw_text(list, {x, outer.y}, curve.colour, curve.name);
    x += width_of(curve.name) + 10 * style.unit;
  }
}

void draw_chart(const Chart& chart, const Viewport& outer, const ChartFrame& frame,
                const PanelStyle& style) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  // The axes begin half a line lower.
  const double title = 0.9 * style.line;
  const Viewport below{outer.x, outer.y + title, outer.width, outer.height - title};
  const PlotArea area{inside_axes(below, frame.label_width, style), frame.time, value_span(chart)};
  draw_title(list, chart, outer, style);
  PlotTicks ticks = ticks_of(area, style);
  if (!ticks.x.empty()) ticks.x.back().label += " s";  // Times are in seconds everywhere.
  draw_axes(list, area, ticks, style);
  for (const Span& gap : frame.gaps) {
    const double from = area.at({std::max(gap.from, area.x.from), 0}).x;
    const double to = area.at({std::min(gap.to, area.x.to), 0}).x;
    if (to > from) draw_block(list, {from, area.box.y, to - from, area.box.height}, style.grid);
  }
  for (const Curve& curve : chart.curves) {
    draw_curve(list, area, places_of(chart, curve, frame.gaps), curve.colour, 1.6 * style.unit);
  }
  const double now_s = frame.state.source.field->time_s;
  if (now_s >= area.x.from && now_s <= area.x.to) draw_head(list, area, now_s, style);
  take_mouse(chart, area, frame, style);
}

/// Widest y label of all charts, which aligns their axes.
double label_width(const std::vector<Chart>& charts, const PanelStyle& style) {
  double widest = 0;
  for (const Chart& chart : charts) {
    const PlotArea area{{0, 0, 1, kChartHeight * style.unit}, {}, value_span(chart)};
    for (const Tick& tick : ticks_of(area, style).y) {
      widest = std::max(widest, width_of(tick.label));
    }
  }
  return widest;
}

/// Charts in rows that fill the height that is left, as many per row as fit; in a place that is
/// high below each other.
void draw_charts(const std::vector<Chart>& charts, const ChartFrame& frame,
                 const PanelStyle& style) {
  const ImVec2 available = ImGui::GetContentRegionAvail();
  const auto wide = static_cast<double>(available.x);
  const double gap = 14 * style.unit;
  const auto fitting = static_cast<std::size_t>(std::max(wide / (kChartWidth * style.unit), 1.0));
  const std::size_t beside = available.x > available.y ? std::min(fitting, charts.size()) : 1;
  const std::size_t rows = (charts.size() + beside - 1) / beside;
  const double width = (wide - gap * static_cast<double>(beside - 1)) / static_cast<double>(beside);
  const double height =
      std::max(static_cast<double>(available.y) / static_cast<double>(rows) - 4 * style.unit,
               kChartHeight * style.unit);
  for (std::size_t i = 0; i < charts.size(); ++i) {
    if (i % beside != 0) ImGui::SameLine(0, static_cast<float>(gap));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::PushID(static_cast<int>(i));
    ImGui::InvisibleButton("chart", ImVec2(static_cast<float>(width), static_cast<float>(height)));
    draw_chart(charts[i],
               {static_cast<double>(corner.x), static_cast<double>(corner.y), width, height}, frame,
               style);
    ImGui::PopID();
  }
}

/// Progress of a file's survey, while it is under way.
void draw_progress(const AppState& state, const PanelStyle& style) {
  if (state.source.survey == nullptr) return;
  const Survey::Progress progress = state.source.survey->progress();
  if (!progress.failure.empty()) {
    faint_text(style, progress.failure.c_str());
  } else if (progress.done < progress.frames) {
    faint_text(style,
               fmt::format("{} of {} frames measured", progress.done, progress.frames).c_str());
  }
}

}  // namespace

void time_panel(AppState& state) {
  const PanelStyle style = panel_style(state.look.settings.scale);
  if (state.source.curves == nullptr || !state.source.field) return;
  draw_progress(state, style);
  const auto [first_s, last_s] = state.source.curves->time_span();
  const bool live = state.source.player->live() != nullptr;
  const double lasts_s = live ? kLiveSeconds : 0;
  const double now_s = last_s + silence_s(state);
  const Span whole{first_s, std::max(now_s, first_s + TimeWindow::kLeastSeconds)};
  const Span time = state.look.time_window.of(whole, lasts_s);
  const std::vector<Chart> charts = charts_of(state, time, style);
  std::vector<Span> gaps;
  if (live) gaps = gaps_of(charts.front().curves.front().points, now_s);
  draw_charts(charts, {state, whole, time, lasts_s, label_width(charts, style), std::move(gaps)},
              style);
}

}  // namespace pillarfield::viewer
