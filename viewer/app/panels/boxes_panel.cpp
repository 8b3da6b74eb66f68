#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "viewer/app/input/gui_input.h"
#include "viewer/app/input/marks.h"
#include "viewer/app/panels/format_value.h"
#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"

namespace pillarfield::viewer {
namespace {

void number_cell(double value) {
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  flush_right(table_number(value));
}

/// The name in the colour of the box, which can be edited. A name that no box may have is not
/// taken.
void name_cell(NamedBox& box, Theme theme, bool focused) {
  ImGui::TableNextColumn();
  std::array<char, NamedBox::kMostNameBytes + 1> name{};
  std::ranges::copy(box.name, name.begin());
  if (focused) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(padding.y, padding.y));
  ImGui::PushStyleColor(ImGuiCol_Text, packed(pin_colour(box.number, theme)));
  const bool edited =
      ImGui::InputText("##name", name.data(), name.size(), ImGuiInputTextFlags_AutoSelectAll);
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  if (edited && is_box_name(name.data())) box.name = name.data();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", box.name.c_str());
}

/// Returns true where the box is to be removed.
bool write_box(const AppState& state, NamedBox& box, bool focused) {
  const Skin& skin = state.source.player->info().skin;
  const SelectionSums& sums = sums_of(state, box.rect, box.cached);
  ImGui::TableNextRow();
  name_cell(box, state.look.settings.theme, focused);
  const Units& units = state.look.settings.units;
  number_cell(units.shown(Dimension::force, sums.normal));
  if (skin.has_pillars()) {
    number_cell(units.shown(Dimension::force, std::hypot(sums.shear_x, sums.shear_y)));
  }
  const double kpa = static_cast<double>(kpa_per_newton(skin)) * sums.mean_normal;
  number_cell(units.shown(Dimension::pressure, kpa));
  ImGui::TableNextColumn();
  const bool removed = ImGui::Button("×");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("remove this box");
  return removed;
}

struct BoxColumn {
  std::string head;
  std::string_view unit;
  std::string help;
  float width;  ///< 0: what is left
};

std::vector<BoxColumn> box_columns(const AppState& state) {
  const auto button = static_cast<float>(std::ceil(width_of("×")));
  const Units& units = state.look.settings.units;
  std::vector<BoxColumn> columns{{"name", "", "click to rename", 0}};
  const auto add = [&](const char* head, Dimension dimension, const char* help) {
    columns.push_back({head, units.of(dimension).name, help, number_width(head)});
  };
  add("normal", Dimension::force, "total normal force");
  if (state.source.player->info().skin.has_pillars()) {
    add("shear", Dimension::force, "length of the total shear");
  }
  add("pressure", Dimension::pressure, "mean pressure on what is in contact");
  columns.push_back({"", "", "", button + 2 * ImGui::GetStyle().FramePadding.x});
  return columns;
}

void write_box_heads(const std::vector<BoxColumn>& columns) {
  for (const auto& [head, unit, help, width] : columns) {
    ImGui::TableSetupColumn(
        head.c_str(),
        width > 0 ? ImGuiTableColumnFlags_WidthFixed : ImGuiTableColumnFlags_WidthStretch, width);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const auto& [head, unit, help, width] : columns) {
    if (!head.empty()) column_head(head, unit, help, width == 0);
  }
}

}  // namespace

void boxes_panel(AppState& state) {
  if (state.marks.boxes.empty() || !state.source.field) {
    return faint_text(panel_style(state.look.settings.scale), "No part has a name.");
  }
  const std::vector<BoxColumn> columns = box_columns(state);
  constexpr int kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_NoPadOuterX;
  if (!ImGui::BeginTable("boxes", static_cast<int>(columns.size()), kFlags)) return;
  write_box_heads(columns);
  std::optional<std::size_t> removed;
  for (std::size_t i = 0; i < state.marks.boxes.size(); ++i) {
    const bool focused = state.marks.names_box && i + 1 == state.marks.boxes.size();
    ImGui::PushID(state.marks.boxes[i].number);
    if (write_box(state, state.marks.boxes[i], focused)) removed = i;
    ImGui::PopID();
  }
  ImGui::EndTable();
  state.marks.names_box &= !GuiInput::wants_text();
  if (removed)
    state.marks.boxes.erase(state.marks.boxes.begin() + static_cast<std::ptrdiff_t>(*removed));
}

}  // namespace pillarfield::viewer
