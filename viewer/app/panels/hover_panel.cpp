#include <fmt/format.h>

#include <vector>

#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/widgets.h"
#include "viewer/style/quantity.h"

namespace pillarfield::viewer {
namespace {

/// Adds the quantity of the heat map unless another line shows it.
void add_mapped(std::vector<ShownValue>& lines, const AppState& state) {
  const Quantity quantity = state.look.settings.quantity;
  const Skin& skin = state.source.player->info().skin;
  const bool elsewhere = quantity == Quantity::pressure && !skin.has_pillars();
  const bool adds = quantity == Quantity::uncertainty || quantity == Quantity::parity ||
                    quantity == Quantity::pressure;
  if (!adds || elsewhere) return;
  const QuantityInfo info = info_of(quantity);
  const double value = value_of(quantity, *state.source.field, skin, state.marks.hovered->row,
                                state.marks.hovered->col);
  lines.push_back(state.look.settings.units.readout(info.title, info.dimension, value));
}

std::vector<ShownValue> lines_of(const AppState& state, const PillarValues& values) {
  std::vector<ShownValue> lines =
      shown_forces(values, state.source.player->info().skin, state.look.settings.units);
  if (values.has_pillars) {
    for (const ShownValue& value : shown_direction(values, state.look.settings.units)) {
      lines.push_back(value);
    }
  }
  add_mapped(lines, state);
  return lines;
}

/// The same place in the second source, if it has one.
void show_beside(const PanelStyle& style, const AppState& state, PillarIndex pillar) {
  if (!state.source.beside_field) return;
  const ForceFieldView& forces = state.source.beside_field->forces;
  if (pillar.row >= forces.rows || pillar.col >= forces.cols) return;
  leave_gap(style, 4);
  heading(style, state.source.beside_is_truth ? "truth" : state.source.beside->info().name);
  value_table(style, shown_forces(values_at(*state.source.beside_field, pillar),
                                  state.source.beside->info().skin, state.look.settings.units));
}

}  // namespace

void hover_panel(const AppState& state) {
  const PanelStyle style = panel_style(state.look.settings.scale);
  if (!state.source.field || !state.marks.hovered) {
    const char* const name = element_name(state.source.player->info().skin);
    faint_text(style, fmt::format("A click pins a {}, a drag selects.", name).c_str());
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
  if (values.status == 0) return show_beside(style, state, pillar);
  leave_gap(style, 2);
  value_table(style, lines_of(state, values));
  show_beside(style, state, pillar);
}

}  // namespace pillarfield::viewer
