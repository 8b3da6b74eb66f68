#include "viewer/app/panels/panel_style.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/app/panels/format_value.h"

namespace pillarfield::viewer {
namespace {

ImVec4 opaque(ImGuiCol index, const ImVec4& under) {
  const ImVec4& over = ImGui::GetStyleColorVec4(index);
  const auto mix = [&](float below, float above) { return below + over.w * (above - below); };
  return {mix(under.x, over.x), mix(under.y, over.y), mix(under.z, over.z), 1};
}

}  // namespace

PanelStyle panel_style(double scale) {
  const ImVec4 ground = opaque(ImGuiCol_WindowBg, ImVec4(0, 0, 0, 1));
  PanelStyle style{};
  style.ground = ImGui::ColorConvertFloat4ToU32(ground);
  style.text = ImGui::ColorConvertFloat4ToU32(opaque(ImGuiCol_Text, ground));
  // ImGui's colour of disabled text can be too faint to read.
  style.faint = mixed(style.ground, style.text, 0.66);
  style.grid = mixed(style.ground, style.text, 0.16);
  style.raised = mixed(style.ground, style.text, 0.055);
  style.unit = scale;
  style.line = static_cast<double>(ImGui::GetTextLineHeight());
  return style;
}

ImU32 packed(const Colour& colour) { return IM_COL32(colour.red, colour.green, colour.blue, 255); }

ImU32 mixed(ImU32 under, ImU32 over, double share) {
  const ImVec4 below = ImGui::ColorConvertU32ToFloat4(under);
  const ImVec4 above = ImGui::ColorConvertU32ToFloat4(over);
  const auto part = static_cast<float>(share);
  const auto mix = [part](float from, float to) { return from + part * (to - from); };
  return ImGui::ColorConvertFloat4ToU32(
      ImVec4(mix(below.x, above.x), mix(below.y, above.y), mix(below.z, above.z), 1));
}

ImU32 with_alpha(ImU32 colour, double alpha) {
  ImVec4 parts = ImGui::ColorConvertU32ToFloat4(colour);
  parts.w = static_cast<float>(std::clamp(alpha, 0.0, 1.0));
  return ImGui::ColorConvertFloat4ToU32(parts);
}

double width_of(const std::string& text) {
  return static_cast<double>(ImGui::CalcTextSize(text.c_str()).x);
}

void flush_right(const std::string& words) {
  const float left_over = ImGui::GetContentRegionAvail().x - static_cast<float>(width_of(words));
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(left_over, 0.0f));
  ImGui::TextUnformatted(words.c_str());
}

void column_head(const std::string& words, std::string_view unit, const std::string& help,
                 bool left) {
  ImGui::TableNextColumn();
  ImGui::BeginGroup();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
  if (left) {
    ImGui::TextUnformatted(words.c_str());
  } else {
    flush_right(words);
  }
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_TextDisabled));
  flush_right(std::string(unit));
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  ImGui::EndGroup();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help.c_str());
}

float number_width(const std::string& head) {
  return static_cast<float>(std::ceil(std::max(width_of(head), width_of("\u22120.0000"))));
}

void draw_text(ImDrawList& list, Vec2 place, ImU32 colour, const std::string& text, Align align) {
  if (align != Align::left) place.x -= (align == Align::middle ? 0.5 : 1) * width_of(text);
  list.AddText(to_imgui({std::round(place.x), std::round(place.y)}), colour, text.c_str());
}

void draw_block(ImDrawList& list, const Viewport& box, ImU32 colour) {
  const double left = std::round(box.x);
  const double top = std::round(box.y);
  const double right = std::max(std::round(box.x + box.width), left + 1);
  const double bottom = std::max(std::round(box.y + box.height), top + 1);
  list.AddRectFilled(to_imgui({left, top}), to_imgui({right, bottom}), colour);
}

Viewport reserve(double width, double height) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const double wide = width > 0 ? width : static_cast<double>(ImGui::GetContentRegionAvail().x);
  ImGui::Dummy(to_imgui({std::max(wide, 1.0), height}));
  return {static_cast<double>(corner.x), static_cast<double>(corner.y), std::max(wide, 1.0),
          height};
}

void leave_gap(const PanelStyle& style, double pixels) {
  ImGui::Dummy(to_imgui({1, std::round(pixels * style.unit)}));
}

void faint_text(const PanelStyle& style, const char* words) {
  ImGui::PushStyleColor(ImGuiCol_Text, style.faint);
  ImGui::TextWrapped("%s", words);
  ImGui::PopStyleColor();
}

void heading(const PanelStyle& style, const std::string& words, const std::string& further) {
  ImGui::TextUnformatted(words.c_str());
  if (further.empty()) return;
  // On the same line, at the panel's right edge, if it fits.
  const double available = static_cast<double>(ImGui::GetContentRegionAvail().x);
  if (width_of(words) + width_of(further) + 12 * style.unit < available) {
    ImGui::SameLine(0, static_cast<float>(available - width_of(words) - width_of(further)));
  }
  ImGui::PushStyleColor(ImGuiCol_Text, style.faint);
  ImGui::TextUnformatted(further.c_str());
  ImGui::PopStyleColor();
}

namespace {

Colour status_colour(std::uint8_t status, bool pillars, Theme theme) {
  if ((status & status::kSaturated) != 0) return colour_of(Special::saturated, theme);
  if ((status & status::kInconsistent) != 0) {
    return colour_of(is_pressed(status) ? Special::inconsistent : Special::no_reading, theme);
  }
  if ((status & status::kFromNeighbours) != 0) return colour_of(Special::from_contact, theme);
  if (pillars) return region_colour(region_of(status), theme);
  return colour_of(is_pressed(status) ? Special::determined : Special::idle, theme);
}

}  // namespace

void swatch(const PanelStyle& style, ImU32 colour) {
  const double side = std::round(0.66 * style.line);
  const Viewport line = reserve(side, style.line);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Viewport box{line.x, line.y + std::round(0.5 * (style.line - side)) + 1, side, side};
  draw_block(list, box, colour);
  list.AddRect(to_imgui({box.x, box.y}), to_imgui({box.x + side, box.y + side}), style.grid);
  ImGui::SameLine(0, static_cast<float>(7 * style.unit));
}

void status_line(const PanelStyle& style, const AppState& state, PillarIndex pillar,
                 std::uint8_t status) {
  const SourceInfo& source = state.source.player->info();
  const bool absent = lacks_sensels(source.calibration, source.skin, pillar.row, pillar.col);
  const bool pillars = source.skin.has_pillars();
  const std::string words = pillars ? format_status(status) : format_sensel_status(status);
  swatch(style, packed(status_colour(status, pillars, state.look.settings.theme)));
  ImGui::TextUnformatted(absent ? "no sensel" : words.c_str());
}

}  // namespace pillarfield::viewer
