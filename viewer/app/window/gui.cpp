#include "viewer/app/window/gui.h"

#include <imgui.h>

#include <algorithm>

#include "viewer/app/input/marks.h"
#include "viewer/app/input/transport.h"
#include "viewer/app/panels/help.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/status_row.h"
#include "viewer/app/panels/view_panel.h"
#include "viewer/app/panels/widgets.h"
#include "viewer/app/window/style.h"
#include "viewer/render/imgui_point.h"

namespace pillarfield::viewer {
namespace {

/// Begins a fixed part of the window without decorations; ImGui::End() ends it.
bool begin(const char* name, const Viewport& box, int more_flags = 0) {
  constexpr int kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNavFocus |
                         ImGuiWindowFlags_NoBringToFrontOnFocus;
  ImGui::SetNextWindowPos(to_imgui({box.x, box.y}));
  ImGui::SetNextWindowSize(to_imgui({box.width, box.height}));
  return ImGui::Begin(name, nullptr, kFlags | more_flags);
}

constexpr int kStill = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;

void column(const Command& command) {
  AppState& state = command.state;
  if (section("View")) view_panel(command);
  if (section("Under the cursor")) hover_panel(state);
  if (section("Pillar")) pillar_panel(state);
  if (section("Selection")) selection_panel(state);
  if (section("Contacts")) contacts_panel(state, command.place);
  if (section("Over time")) time_panel(state);
  if (section("Write")) write_panel(command);
}

/// Thin lines between parts.
void draw_seams(const Screen& screen, Theme theme) {
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const unsigned colour = palette_of(theme).line;
  const auto line = [&](double x0, double y0, double x1, double y1) {
    list.AddRectFilled(to_imgui({x0, y0}), to_imgui({x1, y1}), colour);
  };
  const Viewport& transport = screen.transport;
  const Viewport& status = screen.status;
  line(transport.x, transport.y, transport.x + transport.width, transport.y + 1);
  line(status.x, status.y, status.x + status.width, status.y + 1);
  if (screen.column.width > 0) {
    line(screen.column.x, 0, screen.column.x + 1, screen.column.height);
  }
}

}  // namespace

void draw_gui(const Command& command, const Screen& screen, const std::string& gpu) {
  AppState& state = command.state;
  const float padding = ImGui::GetStyle().WindowPadding.x;
  draw_marks(state, command.place);

  if (screen.column.width > 0) {
    if (begin("column", screen.column)) column(command);
    ImGui::End();
  }

  const float side = 2 * ImGui::GetFontSize();
  const auto above = 0.5f * (static_cast<float>(screen.transport.height) - side);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, std::max(above, 0.0f)));
  if (begin("transport", screen.transport, kStill)) transport(command);
  ImGui::End();
  ImGui::PopStyleVar();

  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette_of(state.settings.theme).background);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  if (begin("status", screen.status, kStill)) status_row(state, gpu);
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();

  draw_seams(screen, state.settings.theme);
  if (state.show_help) help_overlay(screen.field);
}

}  // namespace pillarfield::viewer
