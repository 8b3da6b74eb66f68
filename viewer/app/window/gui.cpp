#include "viewer/app/window/gui.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/app/input/marks.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/widgets.h"
#include "viewer/app/window/style.h"
#include "viewer/render/imgui_point.h"
#include "viewer/render/scene.h"

namespace pillarfield::viewer {
namespace {

constexpr double kColumn = 320;  ///< nominal pixels, as those below
constexpr double kTransport = 36;
constexpr double kStatus = 24;
constexpr double kRow = 131;
constexpr double kFoldedRow = 28;
constexpr double kLeastBeside = 300;    ///< width of curves beside the field
constexpr double kMostOfRow = 0.4;      ///< of the window's height
constexpr double kLeastOfField = 0.55;  ///< of the window, where curves have more than their least
constexpr int kStill = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;

bool has_curves(const AppState& state) {
  return state.source.player->live() != nullptr || state.source.player->info().frames > 1;
}

/// A panel of the column.
struct Panel {
  const char* title = nullptr;
  bool (*has_contents)(const AppState& state) = nullptr;
  void (*draw)(const Command& command) = nullptr;
};

bool always(const AppState& /*state*/) { return true; }

template <bool pillars>
bool has_pins(const AppState& state) {
  return !state.marks.pins.empty() && state.source.player->info().skin.has_pillars() == pillars;
}

constexpr std::array kPanels{
    Panel{"Sensor", [](const AppState& state) { return state.source.player->live() != nullptr; },
          sensor_panel},
    Panel{"View", always, view_panel},
    Panel{"Contacts", [](const AppState& state) { return state.look.settings.contacts; },
          [](const Command& command) { contacts_panel(command.state, command.place); }},
    Panel{"Under the cursor", always, [](const Command& command) { hover_panel(command.state); }},
    Panel{"Pillar", has_pins<true>, [](const Command& command) { pillar_panel(command.state); }},
    Panel{"Sensel", has_pins<false>, [](const Command& command) { pillar_panel(command.state); }},
    Panel{"Write", always, write_panel},
};

/// Begins a fixed part of the window and draws its upper and left edge; ImGui::End() ends it.
void begin_part(const char* name, const Viewport& box, Theme theme, int flags = 0) {
  ImGui::SetNextWindowPos(to_imgui({box.x, box.y}));
  ImGui::SetNextWindowSize(to_imgui({box.width, box.height}));
  ImGui::Begin(name, nullptr, fixed_window_flags() | flags);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto line = [&](double width, double height) {
    list.AddRectFilled(to_imgui({box.x, box.y}), to_imgui({box.x + width, box.y + height}),
                       palette_of(theme).line);
  };
  list.PushClipRect(to_imgui({box.x, box.y}), to_imgui({box.x + box.width, box.y + box.height}));
  if (box.y > 0) line(box.width, 1);
  if (box.x > 0) line(1, box.height);
  list.PopClipRect();
}

void draw_column(const Command& command, const Viewport& box) {
  if (box.width < 1) return;
  begin_part("right", box, command.state.look.settings.theme);
  draw_panels(command);
  ImGui::End();
}

/// The curves, whose charts have titles, beside the fold of their panel.
void draw_row(const Command& command, const Viewport& box) {
  if (box.height < 1) return;
  AppState& state = command.state;
  const float padding = ImGui::GetStyle().WindowPadding.x;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, 0.4f * padding));
  begin_part("bottom", box, state.look.settings.theme, kStill);
  ImGui::PopStyleVar();
  const float side = ImGui::GetFontSize();
  const bool open = !state.window.folds_curves;
  ImGui::BeginChild("fold", ImVec2(open ? 1.6f * side : 0, 0), false, kStill);
  ImGui::SetCursorPosX(-0.5f * side);
  ImGui::SetNextItemOpen(open);
  state.window.folds_curves = !section(open ? "##fold" : "Over time");
  ImGui::EndChild();
  if (open) {
    ImGui::SameLine();
    ImGui::BeginChild("charts", ImVec2(0, 0), false, ImGuiWindowFlags_NoScrollWithMouse);
    time_panel(state);
    ImGui::EndChild();
  }
  ImGui::End();
}

/// The status line, before and so above other parts: a long notice has several lines.
void draw_status(const AppState& state, Viewport box, const std::string& gpu) {
  const float width = static_cast<float>(box.width) - 2 * ImGui::GetStyle().WindowPadding.x;
  const float text = ImGui::CalcTextSize(state.window.notice.c_str(), nullptr, false, width).y;
  const double further = std::max(static_cast<double>(text - ImGui::GetFontSize()), 0.0);
  box.y -= further;
  box.height += further;
  const Theme theme = state.look.settings.theme;
  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette_of(theme).background);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  begin_part("status", box, theme, kStill);
  status_row(state, gpu);
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

/// Width and height of the field that whole skins leave free.
Vec2 spare_room(const Viewport& field, double scale, const Sides& sides) {
  if (!(sides.aspect > 0)) return {};
  RenderSettings settings;
  settings.scale = scale;
  const Margins margins = margins_of(settings);
  const double around = margins.left + margins.right + margins.legend;
  const double across = margins.top + margins.bottom;
  return {field.width - around - sides.aspect * (field.height - across),
          field.height - across - (field.width - around) / sides.aspect};
}

}  // namespace

Sides sides_of(const AppState& state) {
  if (!state.window.show_panels || state.source.player == nullptr) return {};
  const SkinSize skin = skin_size(state.source.player->info());
  Sides sides{.column = true, .aspect = skin.width_mm / skin.height_mm};
  if (has_curves(state)) sides.row = state.window.folds_curves ? kFoldedRow : kRow;
  return sides;
}

Screen divide(std::uint32_t width, std::uint32_t height, double scale, const Sides& sides) {
  const double wide = std::max(width, 1u);
  const double high = std::max(height, 1u);
  const double status = std::min(std::round(kStatus * scale), high - 1);
  const double transport = std::min(std::round(kTransport * scale), high - 1 - status);
  const double above = high - status;
  // In a narrow window the column takes about a third, in a low one the row too.
  const double column = sides.column ? std::round(std::min(kColumn * scale, 0.36 * wide)) : 0;
  const double middle = std::max(wide - column, 1.0);
  const double free = above - transport;
  const Vec2 spare = spare_room({0, 0, middle, free}, scale, sides);
  const double least = kLeastOfField * wide * high;
  const double beside = std::floor(std::min(spare.x, middle - least / std::max(free, 1.0)));
  const bool stands_beside =
      sides.row > kFoldedRow && beside >= kLeastBeside * scale && free >= kRow * scale;
  double row = stands_beside ? 0 : std::min(sides.row * scale, kMostOfRow * above);
  if (sides.row > kFoldedRow) row = std::max(row, std::min(spare.y, free - least / middle));
  row = std::round(row);
  const double left = stands_beside ? middle - beside : middle;
  const double field = std::max(free - row, 1.0);
  return {.field = {0, 0, left, field},
          .column = {middle, 0, wide - middle, above},
          .row = stands_beside ? Viewport{left, 0, beside, above}
                               : Viewport{0, field + transport, left, above - field - transport},
          .transport = {0, field, left, transport},
          .status = {0, above, wide, status}};
}

int fixed_window_flags() {
  return ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
         ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
         ImGuiWindowFlags_NoNavFocus | ImGuiWindowFlags_NoBringToFrontOnFocus;
}

void draw_panels(const Command& command) {
  for (const Panel& panel : kPanels) {
    if (!panel.has_contents(command.state)) continue;
    ImGui::PushID(panel.title);
    if (section(panel.title)) panel.draw(command);
    ImGui::PopID();
  }
}

void draw_gui(const Command& command, const Screen& screen, const std::string& gpu) {
  AppState& state = command.state;
  const Theme theme = state.look.settings.theme;
  const float padding = ImGui::GetStyle().WindowPadding.x;
  draw_marks(state, command.place);
  draw_silence(state, command.place.area);
  draw_status(state, screen.status, gpu);
  draw_column(command, screen.column);
  draw_row(command, screen.row);

  const float side = 2 * ImGui::GetFontSize();
  const auto above = 0.5f * (static_cast<float>(screen.transport.height) - side);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, std::max(above, 0.0f)));
  begin_part("transport", screen.transport, theme, kStill);
  transport(command);
  ImGui::End();
  ImGui::PopStyleVar();

  if (!state.window.show_help) return;
  const Viewport window{0, 0, screen.status.width, screen.status.y};
  state.window.help_place = help_overlay(window, state.source.player->info());
}

}  // namespace pillarfield::viewer
