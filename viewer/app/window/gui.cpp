#include "viewer/app/window/gui.h"

#include <imgui.h>

#include <algorithm>

#include "viewer/app/input/marks.h"
#include "viewer/app/input/transport.h"
#include "viewer/app/panels/help.h"
#include "viewer/app/panels/status_row.h"
#include "viewer/app/window/docks.h"
#include "viewer/app/window/style.h"
#include "viewer/render/imgui_point.h"

namespace pillarfield::viewer {
void draw_gui(const Command& command, const Screen& screen, const std::string& gpu) {
  constexpr int kStill = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
  AppState& state = command.state;
  const Theme theme = state.settings.theme;
  const float padding = ImGui::GetStyle().WindowPadding.x;
  draw_marks(state, command.place);
  if (state.beside != nullptr) draw_marks(state, beside_place(state, command.place));
  draw_docks(command, screen);

  const float side = 2 * ImGui::GetFontSize();
  const auto above = 0.5f * (static_cast<float>(screen.transport.height) - side);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, std::max(above, 0.0f)));
  begin_part("transport", screen.transport, theme, kStill);
  transport(command);
  ImGui::End();
  ImGui::PopStyleVar();

  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette_of(theme).background);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  begin_part("status", screen.status, theme, kStill);
  status_row(state, gpu);
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();

  if (state.show_help) help_overlay(screen.field);
}

}  // namespace pillarfield::viewer
