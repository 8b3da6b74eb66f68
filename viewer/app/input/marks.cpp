#include "viewer/app/input/marks.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "viewer/app/panels/panel_style.h"
#include "viewer/render/ground.h"
#include "viewer/render/imgui_point.h"

namespace pillarfield::viewer {
namespace {

/// Draws over the picture, with an edge visible on any colour.
class Marker {
 public:
  Marker(const AppState& state, const FieldPlace& place)
      : settings_(state.look.settings),
        place_(place),
        ground_(state.source.field ? &*state.source.field : nullptr, *place.source,
                state.look.settings, place.plot(state.look.settings)),
        list_(*ImGui::GetBackgroundDrawList()),
        unit_(static_cast<float>(state.look.settings.scale)) {}

  void outline(const PillarIndex& pillar) const {
    const auto points = ground_.outline({pillar.row, pillar.row + 1, pillar.col, pillar.col + 1});
    draw_outline(list_, points, IM_COL32(0, 0, 0, 200), 3 * unit_);
    draw_outline(list_, points, IM_COL32(255, 255, 255, 230), 1.4f * unit_);
  }

  void pin(const Pin& pin, bool inspected) const {
    const auto middle = middle_of(pin.pillar);
    if (!middle) return;
    const float radius = 9 * unit_;
    const float reach = radius + 5 * unit_;
    const ImVec2 tip = to_imgui(*middle);
    const ImVec2 head(std::round(tip.x + reach), std::round(tip.y - reach));
    const ImU32 fill = packed(pin_colour(pin.number, Theme::dark));
    const ImU32 edge = IM_COL32(10, 13, 18, 255);
    list_.AddLine(tip, head, edge, 3 * unit_);
    list_.AddLine(tip, head, fill, 1.4f * unit_);
    list_.AddCircleFilled(tip, 2.5f * unit_, edge);
    list_.AddCircleFilled(tip, 1.5f * unit_, fill);
    const ImU32 rim = inspected ? IM_COL32(255, 255, 255, 255) : edge;
    list_.AddCircleFilled(head, radius + 2.5f * unit_, edge);
    list_.AddCircleFilled(head, radius + 1.5f * unit_, rim);
    list_.AddCircleFilled(head, radius, fill);
    const std::string words = fmt::format("{}", pin.number);
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    list_.AddText(ImVec2(std::round(head.x - size.x / 2), std::round(head.y - size.y / 2)), edge,
                  words.c_str());
  }

  void clip() const {
    const Viewport plot = place_.plot(settings_);
    list_.PushClipRect(to_imgui({plot.x, plot.y}),
                       to_imgui({plot.x + plot.width, plot.y + plot.height}));
  }
  void unclip() const { list_.PopClipRect(); }

 private:
  [[nodiscard]] std::optional<SeenPoint> middle_of(const PillarIndex& pillar) const {
    const Vec2 corner = corner_of(place_, pillar.row, pillar.col);
    const Pitch half_mm = 0.5 * place_.source->skin.element_pitch_mm();
    return ground_.seen({corner.x + half_mm.col_mm, corner.y - half_mm.row_mm});
  }

  const RenderSettings& settings_;
  const FieldPlace& place_;
  Ground ground_;
  ImDrawList& list_;
  float unit_;
};

}  // namespace

void draw_marks(const AppState& state, const FieldPlace& place) {
  const Marker marker(state, place);
  marker.clip();
  if (state.marks.hovered) marker.outline(*state.marks.hovered);
  for (std::size_t i = 0; i < state.marks.pins.size(); ++i) {
    marker.pin(state.marks.pins[i], i + 1 == state.marks.pins.size());
  }
  marker.unclip();
}

namespace {

using PinColours = std::array<Colour, Marks::kMostPins>;

// After Okabe and Ito; lighter on a dark background, darker on a light one.
constexpr PinColours kOnDark{{{86, 180, 233},
                              {240, 167, 50},
                              {38, 198, 150},
                              {222, 140, 185},
                              {240, 228, 88},
                              {236, 112, 60}}};
constexpr PinColours kOnLight{
    {{0, 106, 170}, {196, 122, 0}, {0, 134, 98}, {174, 84, 134}, {110, 100, 0}, {196, 70, 0}}};

bool is_taken(const Marks& marks, int number) {
  return std::ranges::any_of(marks.pins, [number](const Pin& pin) { return pin.number == number; });
}

}  // namespace

void number_pins(Marks& marks) {
  for (Pin& pin : marks.pins) {
    if (pin.number != 0) continue;
    int number = 1;
    while (is_taken(marks, number)) ++number;
    pin.number = number;
  }
}

void inspect_pin(Marks& marks, std::size_t index) {
  if (index >= marks.pins.size()) return;
  const auto pin = marks.pins.begin() + static_cast<std::ptrdiff_t>(index);
  std::rotate(pin, pin + 1, marks.pins.end());
}

void remove_pin(Marks& marks, std::size_t index) {
  if (index >= marks.pins.size()) return;
  marks.pins.erase(marks.pins.begin() + static_cast<std::ptrdiff_t>(index));
}

Colour pin_colour(int number, Theme theme) {
  const PinColours& colours = theme == Theme::dark ? kOnDark : kOnLight;
  const auto index = static_cast<std::size_t>(std::max(number, 1) - 1);
  return colours[index % colours.size()];
}

}  // namespace pillarfield::viewer
