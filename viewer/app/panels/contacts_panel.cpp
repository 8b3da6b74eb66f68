#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

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

float column_width(const ContactColumn& column) {
  return static_cast<float>(std::ceil(std::max(width_of(column.head), width_of(column.widest))));
}

/// The first columns, as far as they fit; a tooltip has the others.
std::span<const ContactColumn> fitting_columns(SkinLayout layout) {
  const std::vector<ContactColumn>& all = contact_columns(layout);
  const ImGuiStyle& style = ImGui::GetStyle();
  float left = ImGui::GetContentRegionAvail().x + 2 * style.CellPadding.x;
  std::size_t count = 0;
  while (count < all.size() && left >= column_width(all[count]) + 2 * style.CellPadding.x) {
    left -= column_width(all[count++]) + 2 * style.CellPadding.x;
  }
  return {all.data(), std::max<std::size_t>(count, 2)};
}

void set_columns(std::span<const ContactColumn> columns) {
  for (const ContactColumn& column : columns) {
    ImGui::TableSetupColumn(column.head, ImGuiTableColumnFlags_WidthFixed, column_width(column));
  }
}

/// Fixed head row above the scrolled contacts.
void write_head(std::span<const ContactColumn> columns, const PressureUnit& unit) {
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (const ContactColumn& column : columns) {
    ImGui::TableNextColumn();
    ImGui::TableHeader(column.head);
    if (!ImGui::IsItemHovered()) continue;
    const bool pressure = column.pressure_kpa != nullptr;
    ImGui::SetTooltip("%s%s%s", column.help, pressure ? ", " : "",
                      pressure ? std::string(unit.name).c_str() : "");
  }
}

/// All values of a row, also those that do not fit, and how sure they are.
void show_all(const std::vector<std::string>& words, const ContactQuantities& contact,
              SkinLayout layout) {
  const std::vector<ContactColumn>& columns = contact_columns(layout);
  std::string lines;
  for (std::size_t i = 0; i < words.size(); ++i) {
    lines += fmt::format("{}{}  {}", i == 0 ? "" : "\n", columns[i].head, words[i]);
  }
  if (const std::string details = format_slip_details(contact); !details.empty()) {
    lines += "\n" + details;
  }
  ImGui::SetTooltip("%s", lines.c_str());
}

/// Returns true if clicked.
bool write_row(const std::string& name, const ContactQuantities& contact, SkinLayout layout,
               const PressureUnit& unit) {
  bool clicked = false;
  const auto words = format_contact(name, contact, layout, unit);
  ImGui::TableNextRow();
  for (std::size_t i = 0; i < static_cast<std::size_t>(ImGui::TableGetColumnCount()); ++i) {
    ImGui::TableNextColumn();
    if (i == 0) {
      clicked = ImGui::Selectable(words[i].c_str(), false, ImGuiSelectableFlags_SpanAllColumns);
      if (ImGui::IsItemHovered()) show_all(words, contact, layout);
    } else {
      flush_right(words[i]);
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
  const float row = static_cast<float>(style.line) + 2 * ImGui::GetStyle().CellPadding.y;
  const float height = row * static_cast<float>(rows) + 2;
  const auto columns = fitting_columns(layout);
  if (!ImGui::BeginTable("contacts", static_cast<int>(columns.size()), kTableFlags,
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
