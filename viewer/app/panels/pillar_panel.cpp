#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "viewer/app/input/marks.h"
#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/widgets.h"
#include "viewer/style/quantity.h"

namespace pillarfield::viewer {
namespace {

/// A button with a pin's number in its colour, filled for the inspected pin. True if clicked.
bool pin_button(const PanelStyle& style, const Pin& pin, Theme theme, bool inspected) {
  const double side = std::round(style.line + 6 * style.unit);
  const std::string name = fmt::format("pin {}", pin.number);
  const bool clicked = ImGui::InvisibleButton(name.c_str(), to_imgui({side, side}));
  const bool lit = inspected || ImGui::IsItemHovered();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", format_pillar(pin.pillar).c_str());
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  const ImU32 colour = packed(pin_colour(pin.number, theme));
  const auto rounding = static_cast<float>(4 * style.unit);
  if (lit) list.AddRectFilled(low, high, inspected ? colour : with_alpha(colour, 0.3), rounding);
  list.AddRect(low, high, colour, rounding, ImDrawFlags_None, static_cast<float>(1.4 * style.unit));
  const double middle = static_cast<double>(low.x) + 0.5 * side;
  const double top = static_cast<double>(low.y) + 0.5 * (side - style.line);
  draw_text(list, {middle, top}, inspected ? style.ground : style.text, std::to_string(pin.number),
            Align::middle);
  return clicked;
}

/// A cross at the right edge that removes the inspected pin. True if clicked.
bool remove_button(const PanelStyle& style) {
  const double side = std::round(style.line + 6 * style.unit);
  const auto right = ImGui::GetWindowContentRegionMax().x;
  ImGui::SameLine(right - static_cast<float>(side));
  const bool clicked = ImGui::InvisibleButton("remove", to_imgui({side, side}));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("remove this pin");
  const ImU32 colour = ImGui::IsItemHovered() ? style.text : style.faint;
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  const auto inset = static_cast<float>(0.33 * side);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto width = static_cast<float>(1.5 * style.unit);
  list.AddLine({low.x + inset, low.y + inset}, {high.x - inset, high.y - inset}, colour, width);
  list.AddLine({low.x + inset, high.y - inset}, {high.x - inset, low.y + inset}, colour, width);
  return clicked;
}

/// Buttons in the order of pin numbers, so that choosing one does not move them.
void choose_pin(const PanelStyle& style, AppState& state) {
  std::vector<std::size_t> order;
  for (std::size_t index = 0; index < state.marks.pins.size(); ++index) order.push_back(index);
  std::ranges::sort(order, {}, [&](std::size_t index) { return state.marks.pins[index].number; });
  std::optional<std::size_t> chosen;
  for (const std::size_t index : order) {
    const bool inspected = index + 1 == state.marks.pins.size();
    if (pin_button(style, state.marks.pins[index], state.look.settings.theme, inspected))
      chosen = index;
    ImGui::SameLine(0, static_cast<float>(6 * style.unit));
  }
  const bool removed = remove_button(style);
  if (chosen) inspect_pin(state.marks, *chosen);
  if (removed) remove_pin(state.marks, state.marks.pins.size() - 1);
}

void draw_readings(const PanelStyle& style, const AppState& state, const PillarValues& values,
                   ImU32 colour) {
  const Pin& pin = state.marks.pins.back();
  const SourceInfo& source = state.source.player->info();
  const auto bars = reading_bars(values, pin.pillar, source);
  const double full = full_bar(bars, source, state.source.field->raw.type);
  const Viewport box = reserve(kReadingBarsSize.x * style.unit, kReadingBarsSize.y * style.unit);
  draw_reading_bars(*ImGui::GetWindowDrawList(), {box.x, box.y}, bars, full, colour, style);
}

/// Adds the quantity of the heat map unless another line shows it.
void add_mapped(std::vector<ShownValue>& lines, const AppState& state, PillarIndex pillar) {
  const Quantity quantity = state.look.settings.quantity;
  const Skin& skin = state.source.player->info().skin;
  const bool elsewhere = quantity == Quantity::pressure && !skin.has_pillars();
  const bool adds = quantity == Quantity::uncertainty || quantity == Quantity::parity ||
                    quantity == Quantity::pressure;
  if (!adds || elsewhere) return;
  const QuantityInfo info = info_of(quantity);
  const double value = value_of(quantity, *state.source.field, skin, pillar.row, pillar.col);
  lines.push_back(state.look.settings.units.readout(info.title, info.dimension, value));
}

/// Force and direction of an element.
std::vector<ShownValue> lines_of(const AppState& state, const PillarValues& values,
                                 PillarIndex pillar) {
  std::vector<ShownValue> lines =
      shown_forces(values, state.source.player->info().skin, state.look.settings.units);
  if (values.has_pillars) {
    for (const ShownValue& value : shown_direction(values, state.look.settings.units)) {
      lines.push_back(value);
    }
  }
  add_mapped(lines, state, pillar);
  return lines;
}

bool is_in(const ForceFieldView& forces, PillarIndex pillar) {
  return pillar.row < forces.rows && pillar.col < forces.cols;
}

}  // namespace

void pillar_panel(AppState& state) {
  const PanelStyle style = panel_style(state.look.settings.scale);
  number_pins(state.marks);
  if (state.marks.pins.empty()) {
    const char* const name = element_name(state.source.player->info().skin);
    faint_text(style, fmt::format("Click a {} to pin it.", name).c_str());
    return;
  }
  choose_pin(style, state);
  if (state.marks.pins.empty() || !state.source.field) return;
  const Pin& pin = state.marks.pins.back();
  if (!is_in(state.source.field->forces, pin.pillar)) return;
  const PillarValues values = values_at(*state.source.field, pin.pillar);
  const ImU32 colour = packed(pin_colour(pin.number, state.look.settings.theme));
  const Pitch pitch_mm = state.source.player->info().skin.element_pitch_mm();
  heading(
      style, format_pillar(pin.pillar),
      format_place(state.source.field->forces, pin.pillar, pitch_mm, state.look.settings.units));
  status_line(style, state, pin.pillar, values.status);
  if (state.source.field->raw.data == nullptr) {
    faint_text(style, "The source has no readings.");
  } else if (values.has_pillars) {
    draw_readings(style, state, values, colour);
  } else {
    faint_text(style, format_readings(values).c_str());
  }
  leave_gap(style, 2);
  value_table(style, lines_of(state, values, pin.pillar));
}

void hover_panel(const AppState& state) {
  const PanelStyle style = panel_style(state.look.settings.scale);
  if (!state.source.field || !state.marks.hovered) {
    const char* const name = element_name(state.source.player->info().skin);
    faint_text(style, fmt::format("A click pins a {}.", name).c_str());
    return;
  }
  const PillarIndex pillar = *state.marks.hovered;
  const PillarValues values = values_at(*state.source.field, pillar);
  const Pitch pitch_mm = state.source.player->info().skin.element_pitch_mm();
  heading(style, format_pillar(pillar),
          format_place(state.source.field->forces, pillar, pitch_mm, state.look.settings.units));
  status_line(style, state, pillar, values.status);
  if (state.source.field->raw.data != nullptr) {
    faint_text(style, format_readings(values).c_str());
  }
  if (values.status == 0) return;
  leave_gap(style, 2);
  value_table(style, lines_of(state, values, pillar));
}

}  // namespace pillarfield::viewer
