#include "viewer/app/window/docks.h"

#include <imgui.h>

#include <algorithm>

#include "viewer/app/input/marks.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/widgets.h"
#include "viewer/app/window/panel_layout.h"
#include "viewer/app/window/style.h"
#include "viewer/render/imgui_point.h"

namespace pillarfield::viewer {
namespace {

constexpr double kLeastColumn = 160;  ///< nominal pixels
constexpr double kLeastRow = 60;
constexpr float kGrip = 6;  ///< width of an edge that can be dragged, nominal pixels

void draw_panel(PanelId id, const Command& command) {
  AppState& state = command.state;
  switch (id) {
    case PanelId::sensor:
      return sensor_panel(command);
    case PanelId::view:
      return view_panel(command);
    case PanelId::write:
      return write_panel(command);
    case PanelId::contacts:
      return contacts_panel(state, command.place);
    case PanelId::cursor:
      return hover_panel(state);
    case PanelId::pillar:
      return pillar_panel(state);
    case PanelId::selection:
      return selection_panel(state);
    case PanelId::boxes:
      return boxes_panel(state);
    case PanelId::curves:
      break;
  }
  time_panel(state);
}

const char* title_in(const AppState& state, PanelId id) {
  return title_of(id, state.player->info().skin.layout);
}

/// Where a panel goes, chosen from a list.
void choose_dock(PanelLayout& layout, PanelId id) {
  for (std::size_t i = 0; i < kDocks; ++i) {
    const auto dock = static_cast<Dock>(i);
    if (ImGui::Selectable(title_of(dock), place_of(layout, id).dock == dock)) {
      move_panel(layout, id, dock);
    }
  }
}

/// A heading that folds its panel, and that can be dragged to another dock; true while open.
bool panel_heading(PanelLayout& layout, PanelId id, const char* title) {
  ImGui::SetNextItemOpen(place_of(layout, id).open);
  const Section heading = section(title);
  place_of(layout, id).open = heading.open;
  if (heading.dragged) layout.dragged = id;
  if (heading.menu) ImGui::OpenPopup("dock");
  if (ImGui::BeginPopup("dock")) {
    choose_dock(layout, id);
    ImGui::EndPopup();
  }
  return heading.open;
}

/// The curves, whose charts have titles, beside the fold of their panel.
void curves_in_row(const Command& command) {
  PanelLayout& layout = command.state.panels;
  const bool open = place_of(layout, PanelId::curves).open;
  const float side = ImGui::GetFontSize();
  ImGui::BeginChild("fold", ImVec2(open ? 1.6f * side : 0, 0), false,
                    ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::SetCursorPosX(-0.5f * side);
  panel_heading(layout, PanelId::curves, open ? "##fold" : title_of(PanelId::curves, {}));
  ImGui::EndChild();
  if (!open) return;
  ImGui::SameLine();
  ImGui::BeginChild("charts", ImVec2(0, 0), false, ImGuiWindowFlags_NoScrollWithMouse);
  time_panel(command.state);
  ImGui::EndChild();
}

void docked_panel(const Command& command, PanelId id) {
  PanelLayout& layout = command.state.panels;
  ImGui::PushID(static_cast<int>(id));
  if (panel_heading(layout, id, title_in(command.state, id))) draw_panel(id, command);
  ImGui::PopID();
}

/// Panels of a dock, copied: drawing may move them.
std::vector<PanelId> panels_in(const AppState& state, Dock dock) {
  std::vector<PanelId> ids;
  for (const PanelPlace& place : state.panels.places) {
    if (place.dock == dock && place.used) ids.push_back(place.id);
  }
  return ids;
}

void draw_column(const Command& command, const char* name, Dock dock, const Viewport& box) {
  if (box.width < 1) return;
  begin_part(name, box, command.state.settings.theme);
  for (const PanelId id : panels_in(command.state, dock)) docked_panel(command, id);
  ImGui::End();
}

/// Panels side by side.
void draw_row(const Command& command, const Viewport& box) {
  if (box.height < 1) return;
  const float padding = ImGui::GetStyle().WindowPadding.x;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, 0.4f * padding));
  begin_part("bottom", box, command.state.settings.theme,
             ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoScrollbar);
  ImGui::PopStyleVar();
  const std::vector<PanelId> ids = panels_in(command.state, Dock::bottom);
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const auto count = static_cast<float>(std::max<std::size_t>(ids.size(), 1));
  const float width = (ImGui::GetContentRegionAvail().x - gap * (count - 1)) / count;
  for (const PanelId id : ids) {
    if (id != ids.front()) ImGui::SameLine();
    ImGui::BeginChild(title_in(command.state, id), ImVec2(width, 0), false,
                      id == PanelId::curves ? ImGuiWindowFlags_NoScrollWithMouse : 0);
    if (id == PanelId::curves) {
      curves_in_row(command);
    } else {
      docked_panel(command, id);
    }
    ImGui::EndChild();
  }
  ImGui::End();
}

void draw_window(const Command& command, PanelId id, double scale) {
  PanelLayout& layout = command.state.panels;
  Viewport& box = place_of(layout, id).window;
  ImGui::SetNextWindowPos(to_imgui({box.x * scale, box.y * scale}), ImGuiCond_Appearing);
  ImGui::SetNextWindowSize(to_imgui({box.width * scale, box.height * scale}), ImGuiCond_Appearing);
  bool stays = true;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 4);
  if (ImGui::Begin(title_in(command.state, id), &stays, ImGuiWindowFlags_NoSavedSettings)) {
    draw_panel(id, command);
  }
  const ImVec2 corner = ImGui::GetWindowPos();
  const ImVec2 size = ImGui::GetWindowSize();
  const auto nominal = [&](float pixels) { return static_cast<double>(pixels) / scale; };
  box = {nominal(corner.x), nominal(corner.y), nominal(size.x), nominal(size.y)};
  ImGui::End();
  ImGui::PopStyleVar(2);
  if (!stays) move_panel(layout, id, Dock::right);
}

/// An edge of a dock; returns how far it is dragged, pixels.
ImVec2 drag_edge(const char* name, const Viewport& box, Theme theme) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  begin_part(name, box, theme, ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar);
  ImGui::InvisibleButton("edge", to_imgui({box.width, box.height}));
  const bool held = ImGui::IsItemActive();
  if (held || ImGui::IsItemHovered()) {
    ImGui::GetWindowDrawList()->AddRectFilled(to_imgui({box.x, box.y}),
                                              to_imgui({box.x + box.width, box.y + box.height}),
                                              palette_of(theme).accent);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  return held ? ImGui::GetIO().MouseDelta : ImVec2(0, 0);
}

void draw_edges(AppState& state, const Screen& screen) {
  const double scale = state.settings.scale;
  const double grip = static_cast<double>(kGrip) * scale;
  const Theme theme = state.settings.theme;
  PanelLayout& layout = state.panels;
  const auto change = [&](double& size, float pixels, double least = kLeastColumn) {
    if (pixels != 0) size = std::max(size + static_cast<double>(pixels) / scale, least);
  };
  const Viewport& left = screen.left;
  const Viewport& right = screen.right;
  const Viewport& bottom = screen.bottom;
  if (left.width > grip) {
    change(layout.left_width,
           drag_edge("left edge", {left.width - grip, 0, grip, left.height}, theme).x);
  }
  if (right.width > grip) {
    change(layout.right_width, -drag_edge("right edge", {right.x, 0, grip, right.height}, theme).x);
  }
  if (bottom.height > grip) {
    const ImVec2 way = drag_edge("bottom edge", {bottom.x, bottom.y, bottom.width, grip}, theme);
    if (way.y != 0 && layout.bottom_height == 0) layout.bottom_height = bottom.height / scale;
    change(layout.bottom_height, -way.y, kLeastRow);
  }
}

/// The dock under the mouse; a margin of the field stands for a dock without panels.
Dock dock_at(const Screen& screen, Vec2 mouse) {
  constexpr double kMargin = 0.12;
  const Viewport& field = screen.field;
  if (contains(screen.left, mouse) || mouse.x < field.x + kMargin * field.width) return Dock::left;
  if (contains(screen.right, mouse) || mouse.x > field.x + (1 - kMargin) * field.width) {
    return Dock::right;
  }
  return mouse.y > field.y + (1 - kMargin) * field.height ? Dock::bottom : Dock::floating;
}

/// The part of the window that a dropped panel will take.
Viewport target_of(const Screen& screen, Dock dock, Vec2 mouse) {
  const Viewport& field = screen.field;
  constexpr double kPart = 0.25;
  switch (dock) {
    case Dock::left:
      if (screen.left.width > 0) return screen.left;
      return {field.x, field.y, kPart * field.width, field.height};
    case Dock::right:
      if (screen.right.width > 0) return screen.right;
      return {field.x + (1 - kPart) * field.width, field.y, kPart * field.width, field.height};
    case Dock::bottom:
      if (screen.bottom.height > 0) return screen.bottom;
      return {field.x, field.y + (1 - kPart) * field.height, field.width, kPart * field.height};
    case Dock::floating:
      break;
  }
  return {mouse.x - 30, mouse.y - 10, kPart * field.width, kPart * field.height};
}

/// Shows the place of a dragged panel, and moves it at the end.
void drop_panel(AppState& state, const Screen& screen) {
  PanelLayout& layout = state.panels;
  if (!layout.dragged) return;
  const ImVec2 at = ImGui::GetIO().MousePos;
  const Vec2 mouse{static_cast<double>(at.x), static_cast<double>(at.y)};
  const Dock dock = dock_at(screen, mouse);
  const Viewport target = target_of(screen, dock, mouse);
  const ImU32 accent = palette_of(state.settings.theme).accent;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const ImVec2 corner = to_imgui({target.x, target.y});
  const ImVec2 end = to_imgui({target.x + target.width, target.y + target.height});
  list.AddRectFilled(corner, end, (accent & 0x00ffffffu) | 0x40000000u);
  list.AddRect(corner, end, accent, 0, 0, 2);
  list.AddText(ImVec2(at.x + 14, at.y), palette_of(state.settings.theme).text,
               title_in(state, *layout.dragged));
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;
  const double scale = state.settings.scale;
  Viewport& box = place_of(layout, *layout.dragged).window;
  if (dock == Dock::floating) {
    box.x = target.x / scale;
    box.y = target.y / scale;
  }
  move_panel(layout, *layout.dragged, dock);
  layout.dragged.reset();
}

}  // namespace

void begin_part(const char* name, const Viewport& box, Theme theme, int flags) {
  ImGui::SetNextWindowPos(to_imgui({box.x, box.y}));
  ImGui::SetNextWindowSize(to_imgui({box.width, box.height}));
  ImGui::Begin(name, nullptr, fixed_window_flags() | flags);
  if ((flags & ImGuiWindowFlags_NoBackground) != 0) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto line = [&](double x, double y, double width, double height) {
    list.AddRectFilled(to_imgui({x, y}), to_imgui({x + width, y + height}), palette_of(theme).line);
  };
  list.PushClipRect(to_imgui({box.x, box.y}), to_imgui({box.x + box.width, box.y + box.height}));
  if (box.y > 0) line(box.x, box.y, box.width, 1);
  const bool is_left_column = box.x == 0 && box.y == 0;
  if (box.x > 0 || is_left_column)
    line(is_left_column ? box.width - 1 : box.x, box.y, 1, box.height);
  list.PopClipRect();
}

int fixed_window_flags() {
  return ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
         ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
         ImGuiWindowFlags_NoNavFocus | ImGuiWindowFlags_NoBringToFrontOnFocus;
}

void mark_used(AppState& state) {
  constexpr double kLineOfNames = 16;
  state.panels.bottom_more = state.boxes.empty() ? 0 : kLineOfNames;
  const bool live = state.player->live() != nullptr;
  for (PanelPlace& place : state.panels.places) {
    switch (place.id) {
      case PanelId::sensor:
        place.used = live;
        break;
      case PanelId::selection:
        place.used = state.selection.has_value();
        break;
      case PanelId::boxes:
        place.used = !state.boxes.empty();
        break;
      case PanelId::contacts:
        place.used = state.settings.contacts;
        break;
      case PanelId::pillar:
        place.used = !state.pins.empty();
        break;
      case PanelId::curves:
        place.used = live || state.player->info().frames > 1;
        break;
      case PanelId::view:
      case PanelId::cursor:
      case PanelId::write:
        break;
    }
  }
}

void draw_docks(const Command& command, const Screen& screen) {
  AppState& state = command.state;
  draw_column(command, "left", Dock::left, screen.left);
  draw_column(command, "right", Dock::right, screen.right);
  draw_row(command, screen.bottom);
  draw_edges(state, screen);
  for (const PanelId id : panels_in(state, Dock::floating)) {
    draw_window(command, id, state.settings.scale);
  }
  drop_panel(state, screen);
}

void draw_gui(const Command& command, const Screen& screen, const std::string& gpu) {
  constexpr int kStill = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
  AppState& state = command.state;
  const Theme theme = state.settings.theme;
  const float padding = ImGui::GetStyle().WindowPadding.x;
  draw_marks(state, command.place);
  if (state.beside != nullptr) draw_marks(state, beside_place(state, command.place));
  draw_silence(state, command.place.area);
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

  if (!state.show_help) return;
  const Viewport window{0, 0, screen.status.width, screen.status.y};
  state.help_place = help_overlay(window, state.player->info());
}

}  // namespace pillarfield::viewer
