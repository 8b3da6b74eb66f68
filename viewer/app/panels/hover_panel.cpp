#include <vector>

#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/status_line.h"
#include "viewer/app/panels/value_table.h"
#include "viewer/style/quantity.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
namespace {

/// What the heat map shows, where no other line tells it.
void add_mapped(std::vector<ShownValue>& lines, const Session& session) {
  const Quantity quantity = session.look.quantity;
  if (quantity != Quantity::uncertainty && quantity != Quantity::parity) return;
  const QuantityInfo& info = info_of(quantity);
  const double value =
      value_of(quantity, *session.field, session.hovered->row, session.hovered->col);
  lines.push_back({info.title, three_digits(value * info.factor), {}, info.unit});
}

std::vector<ShownValue> lines_of(const Session& session, const PillarValues& values) {
  std::vector<ShownValue> lines;
  for (const ShownValue& value : shown_components(values)) lines.push_back(value);
  for (const ShownValue& value : shown_direction(values)) lines.push_back(value);
  add_mapped(lines, session);
  return lines;
}

}  // namespace

void hover_panel(const Session& session) {
  const PanelInk ink = panel_ink(session.look.scale);
  if (!session.field || !session.hovered) {
    faint_words(ink, "No pillar under the cursor.");
    return;
  }
  const PillarIndex pillar = *session.hovered;
  const PillarValues values = values_at(*session.field, pillar);
  const double pitch_mm = session.player->info().skin.pillar_pitch_mm();
  heading(ink, pillar_words(pillar), place_words(session.field->forces, pillar, pitch_mm));
  status_line(ink, values.status, session.look.theme);
  if (session.field->raw.data != nullptr) {
    faint_words(ink, ("readings 1–4: " + readings_words(values.readings)).c_str());
  }
  if (values.status == 0) return;
  leave_gap(ink, 2);
  value_table(ink, lines_of(session, values));
}

}  // namespace pillarfield::viewer
