#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "viewer/app/input/actions.h"
#include "viewer/app/panels/format_value.h"
#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/render/contact_marks.h"
#include "viewer/source/shown_contacts.h"

namespace pillarfield::viewer {
namespace {

constexpr int kTableFlags = ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY |
                            ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit |
                            ImGuiTableFlags_BordersInnerV;
constexpr std::size_t kMostRows = 9;  ///< visible at a time

/// Columns of fixed width.
void set_columns(SkinLayout layout) {
  for (const ContactColumn& column : contact_columns(layout)) {
    const double width = std::max(width_of(column.head), width_of(column.widest));
    ImGui::TableSetupColumn(column.head, ImGuiTableColumnFlags_WidthFixed,
                            static_cast<float>(std::ceil(width)));
  }
}

/// Fixed head row above the scrolled contacts.
void write_head(SkinLayout layout, const PressureUnit& unit) {
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const ContactColumn& column : contact_columns(layout)) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(column.head);
    if (!ImGui::IsItemHovered()) continue;
    const bool pressure = column.pressure_kpa != nullptr;
    ImGui::SetTooltip("%s%s%s", column.help, pressure ? ", " : "",
                      pressure ? std::string(unit.name).c_str() : "");
  }
}

void write_right(const std::string& words) {
  const float left_over = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(words.c_str()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(left_over, 0.0f));
  ImGui::TextUnformatted(words.c_str());
}

/// Returns true if clicked.
bool write_row(const std::string& name, const ContactQuantities& contact, SkinLayout layout,
               const PressureUnit& unit) {
  bool clicked = false;
  const auto words = format_contact(name, contact, layout, unit);
  ImGui::TableNextRow();
  for (std::size_t i = 0; i < words.size(); ++i) {
    ImGui::TableNextColumn();
    if (i == 0) {
      clicked = ImGui::Selectable(words[i].c_str(), false, ImGuiSelectableFlags_SpanAllColumns);
    } else {
      write_right(words[i]);
    }
  }
  return clicked;
}

/// Index of the clicked contact in the frame's contacts.
std::optional<std::size_t> contact_rows(const ShownContacts& contacts, SkinLayout layout,
                                        const PressureUnit& unit) {
  std::optional<std::size_t> clicked;
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(contacts.above_noise));
  while (clipper.Step()) {
    for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
      const std::size_t place = contacts.heaviest[static_cast<std::size_t>(row)];
      const TrackedContact& contact = contacts.found.contacts[place];
      if (write_row(std::to_string(contact.track_id), contact.quantities, layout, unit))
        clicked = place;
    }
  }
  return clicked;
}

std::optional<std::size_t> contact_table(const PanelStyle& style, const ShownContacts& contacts,
                                         SkinLayout layout, const PressureUnit& unit) {
  const std::size_t rows = std::min(contacts.above_noise, kMostRows) + 2;
  const ImGuiStyle& imgui_style = ImGui::GetStyle();
  const float row = static_cast<float>(style.line) + 2 * imgui_style.CellPadding.y;
  const float height = row * static_cast<float>(rows) + imgui_style.ScrollbarSize + 2;
  if (!ImGui::BeginTable("contacts", static_cast<int>(contact_columns(layout).size()), kTableFlags,
                         ImVec2(0, height))) {
    return std::nullopt;
  }
  ImGui::TableSetupScrollFreeze(1, 2);
  set_columns(layout);
  write_head(layout, unit);
  write_row("all", contacts.found.total, layout, unit);
  const auto clicked = contact_rows(contacts, layout, unit);
  ImGui::EndTable();
  return clicked;
}

}  // namespace

void contacts_panel(AppState& state, const FieldPlace& place) {
  const PanelStyle style = panel_style(state.settings.scale);
  if (!state.settings.contacts || !state.field || state.field->contacts == nullptr) {
    faint_text(style, "Contacts are off; K shows them.");
    return;
  }
  const ShownContacts& contacts = *state.field->contacts;
  const SkinLayout layout = state.player->info().skin.layout;
  if (const auto clicked = contact_table(style, contacts, layout, state.settings.pressure_unit)) {
    mark_contact(state, place, contacts.found.contacts[*clicked].quantities.centre_of_pressure,
                 contacts.extents[*clicked]);
  }
  if (const std::size_t noise = contacts.heaviest.size() - contacts.above_noise; noise > 0) {
    faint_text(
        style,
        fmt::format("{} single {} at the noise are not listed", noise, name_of(layout)).c_str());
  }
  if (const std::string warning = contacts_left_out(contacts); !warning.empty()) {
    faint_text(style, warning.c_str());
  }
}

}  // namespace pillarfield::viewer
