#include "viewer/app/panels/status_line.h"

#include <array>
#include <cmath>

#include "viewer/app/panels/format_value.h"

namespace pillarfield::viewer {
namespace {

Colour status_colour(std::uint8_t status, Theme theme) {
  if ((status & status::kSaturated) != 0) return colour_of(Special::saturated, theme);
  if ((status & status::kInconsistent) != 0) {
    return colour_of(is_pressed(status) ? Special::inconsistent : Special::no_reading, theme);
  }
  if ((status & status::kFromNeighbours) != 0) return colour_of(Special::from_contact, theme);
  return region_colour(region_of(status), theme);
}

}  // namespace

Colour region_colour(Region region, Theme theme) {
  constexpr std::array<Special, kRegions> kSpecial{Special::idle,     Special::region_1,
                                                   Special::region_2, Special::region_3,
                                                   Special::region_4, Special::opposite};
  return colour_of(kSpecial[static_cast<std::size_t>(region)], theme);
}

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
  const SourceInfo& source = state.player->info();
  const bool absent = lacks_sensels(source.calibration, source.skin, pillar.row, pillar.col);
  swatch(style, packed(status_colour(status, state.settings.theme)));
  ImGui::TextUnformatted(absent ? "no sensel" : format_status(status).c_str());
}

}  // namespace pillarfield::viewer
