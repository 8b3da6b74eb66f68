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

/// Width of the column of ids, up to those of the listed contacts.
float width_of_ids(const ShownContacts& contacts) {
  double width = width_of("all");
  for (const std::size_t place : contacts.heaviest) {
    width = std::max(width, width_of(std::to_string(contacts.found.contacts[place].track_id)));
  }
  return static_cast<float>(std::ceil(width));
}

float width_of_column(const QuantityColumn& column) {
  if (column.kind != ColumnKind::word) return number_width(column.live.head);
  return static_cast<float>(std::ceil(width_of("sticking")));
}

/// The first columns, as far as they fit into `room` pixels; a tooltip has the others.
QuantityColumns fitting_columns(SkinLayout layout, float room) {
  const QuantityColumns all = live_columns(layout);
  const float padding = 2 * ImGui::GetStyle().CellPadding.x;
  std::size_t count = 0;
  while (count < all.size() && room >= width_of_column(all[count]) + padding) {
    room -= width_of_column(all[count++]) + padding;
  }
  return all.first(std::max<std::size_t>(count, 1));
}

std::string_view unit_of(const QuantityColumn& column, const PressureUnit& unit) {
  if (is_pressure(column)) return unit.name;
  return column.unit == std::string_view("mm^2") ? "mm²" : column.unit;
}

/// Fixed head row above the scrolled contacts.
void write_head(QuantityColumns columns, const PressureUnit& unit) {
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  column_head("id", "", "constant while the contact is tracked", true);
  for (const QuantityColumn& column : columns) {
    const std::string_view own = unit_of(column, unit);
    column_head(column.live.head, own,
                fmt::format("{}{}{}", column.help, own.empty() ? "" : ", ", own));
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
  clipper.Begin(static_cast<int>(contacts.heaviest.size()));
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
  const std::size_t rows = std::min(contacts.heaviest.size(), kMostRows) + 2;
  const auto line = static_cast<float>(style.line);
  const float height =
      (line + 2 * ImGui::GetStyle().CellPadding.y) * static_cast<float>(rows) + line + 2;
  const float ids = width_of_ids(contacts);
  const float bar = contacts.heaviest.size() > kMostRows ? ImGui::GetStyle().ScrollbarSize : 0;
  const auto columns = fitting_columns(layout, ImGui::GetContentRegionAvail().x - ids - bar);
  if (!ImGui::BeginTable("contacts", static_cast<int>(columns.size()) + 1, kTableFlags,
                         ImVec2(0, height))) {
    return std::nullopt;
  }
  ImGui::TableSetupScrollFreeze(0, 2);
  ImGui::TableSetupColumn("id", ImGuiTableColumnFlags_WidthFixed, ids);
  for (const QuantityColumn& column : columns) {
    ImGui::TableSetupColumn(column.live.head, ImGuiTableColumnFlags_WidthFixed,
                            width_of_column(column));
  }
  write_head(columns, unit);
  write_row("all", contacts.found.total, layout, unit);
  const auto clicked = contact_rows(contacts, layout, unit);
  ImGui::EndTable();
  return clicked;
}

}  // namespace

void contacts_panel(AppState& state, const FieldPlace& place) {
  const PanelStyle style = panel_style(state.look.settings.scale);
  if (!state.source.field || state.source.field->contacts == nullptr) {
    return faint_text(style, "They come with the next frame.");
  }
  const ShownContacts& contacts = *state.source.field->contacts;
  const SkinLayout layout = state.source.player->info().skin.layout;
  if (const auto clicked =
          contact_table(style, contacts, layout, state.look.settings.units.pressure)) {
    show_contact(state, place, contacts.found.contacts[*clicked].quantities.centre_of_pressure);
  }
  if (const std::string warning = contacts_left_out(contacts); !warning.empty()) {
    faint_text(style, warning.c_str());
  }
}

}  // namespace pillarfield::viewer
