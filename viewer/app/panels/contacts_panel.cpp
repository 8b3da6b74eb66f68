#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "viewer/app/input/actions.h"
#include "viewer/app/panels/format_value.h"
#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/render/contact_marks.h"
#include "viewer/source/shown_contacts.h"

namespace pillarfield::viewer {
namespace {

constexpr int kTableFlags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                            ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoPadOuterX;
constexpr std::size_t kMostRows = 9;  ///< visible at a time

constexpr const char* kId = "id";
constexpr const char* kWidestId = "000";

float width_of_column(const char* head, const char* widest) {
  return static_cast<float>(std::ceil(std::max(width_of(head), width_of(widest))));
}

float width_of_column(const QuantityColumn& column) {
  return width_of_column(column.live.head,
                         column.kind == ColumnKind::word ? "sticking" : "\u22120.0000");
}

/// The first columns, as far as they fit beside the id; a tooltip has the others.
QuantityColumns fitting_columns(SkinLayout layout) {
  const QuantityColumns all = live_columns(layout);
  const float padding = 2 * ImGui::GetStyle().CellPadding.x;
  float left = ImGui::GetContentRegionAvail().x - width_of_column(kId, kWidestId);
  std::size_t count = 0;
  while (count < all.size() && left >= width_of_column(all[count]) + padding) {
    left -= width_of_column(all[count++]) + padding;
  }
  return all.first(std::max<std::size_t>(count, 1));
}

void set_columns(QuantityColumns columns) {
  ImGui::TableSetupColumn(kId, ImGuiTableColumnFlags_WidthFixed, width_of_column(kId, kWidestId));
  for (const QuantityColumn& column : columns) {
    ImGui::TableSetupColumn(column.live.head, ImGuiTableColumnFlags_WidthFixed,
                            width_of_column(column));
  }
}

std::string help_of(const QuantityColumn& column, const PressureUnit& unit) {
  const std::string_view own = is_pressure(column) ? unit.name : column.unit;
  return fmt::format("{}{}{}", column.help, own.empty() ? "" : ", ", own);
}

/// Fixed head row above the scrolled contacts.
void write_head(QuantityColumns columns, const PressureUnit& unit) {
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  ImGui::TableNextColumn();
  ImGui::TableHeader(kId);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("constant while the contact is tracked");
  for (const QuantityColumn& column : columns) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(column.live.head);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help_of(column, unit).c_str());
  }
}

/// Shows all quantities of a contact, also those that have no column.
void show_all(const ContactQuantities& contact, SkinLayout layout, const PressureUnit& unit) {
  std::string lines;
  for (const QuantityColumn& column : quantity_columns(contact.wrench.has_value(), layout)) {
    lines += fmt::format("{}{}  {}", lines.empty() ? "" : "\n", name_of(column, unit),
                         format_quantity(column, contact, unit));
  }
  ImGui::SetTooltip("%s", lines.c_str());
}

/// Returns true if clicked.
bool write_row(const std::string& name, const ContactQuantities& contact, SkinLayout layout,
               const PressureUnit& unit) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const bool clicked = ImGui::Selectable(name.c_str(), false, ImGuiSelectableFlags_SpanAllColumns);
  if (ImGui::IsItemHovered()) show_all(contact, layout, unit);
  const auto columns = static_cast<std::size_t>(ImGui::TableGetColumnCount()) - 1;
  for (const QuantityColumn& column : live_columns(layout).first(columns)) {
    ImGui::TableNextColumn();
    flush_right(format_quantity(column, contact, unit));
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
  const float row = static_cast<float>(style.line) + 2 * ImGui::GetStyle().CellPadding.y;
  const float height = row * static_cast<float>(rows) + 2;
  const auto columns = fitting_columns(layout);
  if (!ImGui::BeginTable("contacts", static_cast<int>(columns.size()) + 1, kTableFlags,
                         ImVec2(0, height))) {
    return std::nullopt;
  }
  ImGui::TableSetupScrollFreeze(0, 2);
  set_columns(columns);
  write_head(columns, unit);
  write_row("all", contacts.found.total, layout, unit);
  const auto clicked = contact_rows(contacts, layout, unit);
  ImGui::EndTable();
  return clicked;
}

}  // namespace

void contacts_panel(AppState& state, const FieldPlace& place) {
  const PanelStyle style = panel_style(state.look.settings.scale);
  if (!state.look.settings.contacts || !state.source.field ||
      state.source.field->contacts == nullptr) {
    faint_text(style, "Contacts are off; K shows them.");
    return;
  }
  const ShownContacts& contacts = *state.source.field->contacts;
  const SkinLayout layout = state.source.player->info().skin.layout;
  if (const auto clicked =
          contact_table(style, contacts, layout, state.look.settings.units.pressure)) {
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
