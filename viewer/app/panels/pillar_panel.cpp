#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "viewer/app/input/pins.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/reading_bars.h"
#include "viewer/app/panels/region_plot.h"
#include "viewer/app/panels/status_line.h"
#include "viewer/app/panels/value_table.h"

namespace pillarfield::viewer {
namespace {

/// A button with a pin's number in its colour; filled if it is the inspected one. True if clicked.
bool pin_chip(const PanelInk& ink, const Pin& pin, Theme theme, bool inspected) {
  const double side = std::round(ink.line + 6 * ink.unit);
  const std::string name = fmt::format("pin {}", pin.number);
  const bool clicked = ImGui::InvisibleButton(name.c_str(), point({side, side}));
  const bool lit = inspected || ImGui::IsItemHovered();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", pillar_words(pin.pillar).c_str());
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  const ImU32 colour = packed(pin_colour(pin.number, theme));
  const auto rounding = static_cast<float>(4 * ink.unit);
  if (lit) list.AddRectFilled(low, high, inspected ? colour : with_alpha(colour, 0.3), rounding);
  list.AddRect(low, high, colour, rounding, ImDrawFlags_None, static_cast<float>(1.4 * ink.unit));
  const double middle = static_cast<double>(low.x) + 0.5 * side;
  const double top = static_cast<double>(low.y) + 0.5 * (side - ink.line);
  draw_text(list, {middle, top}, inspected ? ink.ground : ink.text, std::to_string(pin.number),
            Align::middle);
  return clicked;
}

/// A cross at the right edge that removes the inspected pin. True if clicked.
bool remove_button(const PanelInk& ink) {
  const double side = std::round(ink.line + 6 * ink.unit);
  const auto right = ImGui::GetWindowContentRegionMax().x;
  ImGui::SameLine(right - static_cast<float>(side));
  const bool clicked = ImGui::InvisibleButton("remove", point({side, side}));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("remove this pin");
  const ImU32 colour = ImGui::IsItemHovered() ? ink.text : ink.faint;
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  const auto inset = static_cast<float>(0.33 * side);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto width = static_cast<float>(1.5 * ink.unit);
  list.AddLine({low.x + inset, low.y + inset}, {high.x - inset, high.y - inset}, colour, width);
  list.AddLine({low.x + inset, high.y - inset}, {high.x - inset, low.y + inset}, colour, width);
  return clicked;
}

/// Chips in the order of their numbers, so that choosing one does not move them.
void choose_pin(const PanelInk& ink, Session& session) {
  std::vector<std::size_t> order;
  for (std::size_t index = 0; index < session.pins.size(); ++index) order.push_back(index);
  std::ranges::sort(order, {}, [&](std::size_t index) { return session.pins[index].number; });
  std::optional<std::size_t> chosen;
  for (const std::size_t index : order) {
    const bool inspected = index + 1 == session.pins.size();
    if (pin_chip(ink, session.pins[index], session.look.theme, inspected)) chosen = index;
    ImGui::SameLine(0, static_cast<float>(6 * ink.unit));
  }
  const bool removed = remove_button(ink);
  if (chosen) inspect_pin(session, *chosen);
  if (removed) remove_pin(session, session.pins.size() - 1);
}

void draw_readings(const PanelInk& ink, const Session& session, const PillarValues& values,
                   ImU32 colour) {
  const Pin& pin = session.pins.back();
  const SourceInfo& source = session.player->info();
  const auto bars = reading_bars(values, pin.pillar, source);
  const double full = full_bar(bars, source, session.field->raw.type);
  const Viewport room = take_room(kReadingBarsSize.x * ink.unit, kReadingBarsSize.y * ink.unit);
  draw_reading_bars(*ImGui::GetWindowDrawList(), {room.x, room.y}, bars, full, colour, ink);
}

/// The readings, and beside them the direction that follows; below where it is too narrow.
void draw_readings_and_direction(const PanelInk& ink, const Session& session,
                                 const PillarValues& values, ImU32 colour) {
  constexpr double kLeast = 130;
  constexpr double kMost = 190;
  double room = static_cast<double>(ImGui::GetContentRegionAvail().x);
  if (session.field->raw.data == nullptr) {
    faint_words(ink, "The source has no readings.");
  } else {
    draw_readings(ink, session, values, colour);
    const double gap = 16 * ink.unit;
    const double beside = room - kReadingBarsSize.x * ink.unit - gap;
    if (beside >= kLeast * ink.unit) {
      ImGui::SameLine(0, static_cast<float>(gap));
      room = beside;
    }
  }
  readouts(ink, shown_direction(values), std::min(room, kMost * ink.unit));
}

void draw_diagram(const PanelInk& ink, const Session& session, const PillarValues& values,
                  ImU32 colour) {
  const std::string section = section_name(values.status);
  heading(ink, "θ over φ, in degrees", section.empty() ? "" : "region " + section);
  const double room = static_cast<double>(ImGui::GetContentRegionAvail().x);
  const double height = std::clamp(0.5 * room, 120 * ink.unit, 230 * ink.unit);
  const Viewport outer = take_room(0, height);
  draw_region_plot(*ImGui::GetWindowDrawList(), outer, values, session.pins.back().history, ink,
                   colour, session.look.theme);
}

bool is_in(const ForceFieldView& forces, PillarIndex pillar) {
  return pillar.row < forces.rows && pillar.col < forces.cols;
}

}  // namespace

void pillar_panel(Session& session) {
  const PanelInk ink = panel_ink(session.look.scale);
  number_pins(session);
  if (session.pins.empty()) {
    faint_words(ink, "Click a pillar to pin it.");
    return;
  }
  choose_pin(ink, session);
  if (session.pins.empty() || !session.field) return;
  const Pin& pin = session.pins.back();
  if (!is_in(session.field->forces, pin.pillar)) return;
  const PillarValues values = values_at(*session.field, pin.pillar);
  const ImU32 colour = packed(pin_colour(pin.number, session.look.theme));
  const double pitch_mm = session.player->info().skin.pillar_pitch_mm();
  heading(ink, pillar_words(pin.pillar), place_words(session.field->forces, pin.pillar, pitch_mm));
  status_line(ink, values.status, session.look.theme);
  leave_gap(ink, 4);
  draw_readings_and_direction(ink, session, values, colour);
  leave_gap(ink, 2);
  value_table(ink, shown_components(values));
  leave_gap(ink, 4);
  draw_diagram(ink, session, values, colour);
}

}  // namespace pillarfield::viewer
