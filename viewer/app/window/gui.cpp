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
namespace {

/// Begins a fixed part of the window without decorations; ImGui::End() ends it.
bool begin_part(const char* name, const Viewport& box) {
  ImGui::SetNextWindowPos(to_imgui({box.x, box.y}));
  ImGui::SetNextWindowSize(to_imgui({box.width, box.height}));
  return ImGui::Begin(name, nullptr,
                      fixed_window_flags() | ImGuiWindowFlags_NoScrollbar |
                          ImGuiWindowFlags_NoScrollWithMouse);
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
  const Viewport& bottom = screen.bottom;
  if (bottom.height > 0) line(bottom.x, bottom.y, bottom.x + bottom.width, bottom.y + 1);
  if (screen.right.width > 0) {
    line(screen.right.x, 0, screen.right.x + 1, screen.right.height);
  }
  if (screen.left.width > 0) {
    line(screen.left.width - 1, 0, screen.left.width, screen.left.height);
  }
}

}  // namespace

void draw_gui(const Command& command, const Screen& screen, const std::string& gpu) {
  AppState& state = command.state;
  const float padding = ImGui::GetStyle().WindowPadding.x;
  draw_marks(state, command.place);
  if (state.beside != nullptr) draw_marks(state, beside_place(state, command.place));
  draw_docks(command, screen);

  const float side = 2 * ImGui::GetFontSize();
  const auto above = 0.5f * (static_cast<float>(screen.transport.height) - side);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, std::max(above, 0.0f)));
  if (begin_part("transport", screen.transport)) transport(command);
  ImGui::End();
  ImGui::PopStyleVar();

  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette_of(state.settings.theme).background);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  if (begin_part("status", screen.status)) status_row(state, gpu);
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();

  draw_seams(screen, state.settings.theme);
  if (state.show_help) help_overlay(screen.field);
}

}  // namespace pillarfield::viewer
