#include "viewer/app/window/style.h"

#include <imgui.h>

#include <array>

#include "viewer/style/colour_map.h"

namespace pillarfield::viewer {
namespace {

constexpr unsigned colour(unsigned rgb, unsigned alpha = 255) {
  return IM_COL32(rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255, alpha);
}

/// Shades of a theme.
struct Shades {
  unsigned ground, panel, popup, field, field_hovered, field_active, line, text, faint, accent;
};

constexpr Shades kDark{0x0b0e13, 0x14181f, 0x1a1f28, 0x262d38, 0x2f3845,
                       0x3a4554, 0x2a313c, 0xdfe4ea, 0x8a94a3, 0x6fb3b8};
constexpr Shades kLight{0xe9ebee, 0xf6f7f8, 0xffffff, 0xe8eaee, 0xdde1e6,
                        0xd0d6dd, 0xd3d8de, 0x1a1f27, 0x667080, 0x1d7077};

const Shades& shades_of(Theme theme) { return theme == Theme::dark ? kDark : kLight; }

ImVec4 vector(unsigned rgb, float alpha = 1) {
  ImVec4 result = ImGui::ColorConvertU32ToFloat4(colour(rgb));
  result.w = alpha;
  return result;
}

void set_sizes(ImGuiStyle& style) {
  style.WindowPadding = {8, 6};
  style.FramePadding = {7, 3};
  style.ItemSpacing = {8, 5};
  style.ItemInnerSpacing = {6, 4};
  style.CellPadding = {3, 2};
  style.IndentSpacing = 12;
  style.ScrollbarSize = 10;
  style.GrabMinSize = 10;
  style.WindowRounding = 0;
  style.ChildRounding = 0;
  style.PopupRounding = 3;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.ScrollbarRounding = 5;
  style.WindowBorderSize = 0;
  style.ChildBorderSize = 0;
  style.FrameBorderSize = 0;
  style.PopupBorderSize = 1;
}

void set_text(ImGuiStyle& style, const Shades& shades) {
  style.Colors[ImGuiCol_Text] = vector(shades.text);
  style.Colors[ImGuiCol_TextDisabled] = vector(shades.faint);
  style.Colors[ImGuiCol_TextSelectedBg] = vector(shades.accent, 0.35f);
  style.Colors[ImGuiCol_CheckMark] = vector(shades.accent);
  style.Colors[ImGuiCol_PlotLines] = vector(shades.accent);
  style.Colors[ImGuiCol_PlotHistogram] = vector(shades.accent);
  style.Colors[ImGuiCol_SliderGrab] = vector(shades.accent);
  style.Colors[ImGuiCol_SliderGrabActive] = vector(shades.accent);
}

void set_surfaces(ImGuiStyle& style, const Shades& shades) {
  style.Colors[ImGuiCol_WindowBg] = vector(shades.panel);
  style.Colors[ImGuiCol_ChildBg] = vector(shades.panel, 0);
  style.Colors[ImGuiCol_PopupBg] = vector(shades.popup);
  style.Colors[ImGuiCol_Border] = vector(shades.line);
  style.Colors[ImGuiCol_Separator] = vector(shades.line);
  style.Colors[ImGuiCol_TableBorderLight] = vector(shades.line);
  style.Colors[ImGuiCol_TableBorderStrong] = vector(shades.line);
  style.Colors[ImGuiCol_ScrollbarBg] = vector(shades.panel, 0);
  style.Colors[ImGuiCol_ScrollbarGrab] = vector(shades.field_active);
  style.Colors[ImGuiCol_ScrollbarGrabHovered] = vector(shades.faint);
  style.Colors[ImGuiCol_ScrollbarGrabActive] = vector(shades.faint);
}

/// ImGui's colours of an item: at rest, hovered, active.
struct Three {
  int rest, hovered, active;
};

void set_frames(ImGuiStyle& style, const Shades& shades) {
  constexpr std::array kFields{
      Three{ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive},
      Three{ImGuiCol_Button, ImGuiCol_ButtonHovered, ImGuiCol_ButtonActive}};
  for (const Three& three : kFields) {
    style.Colors[three.rest] = vector(shades.field);
    style.Colors[three.hovered] = vector(shades.field_hovered);
    style.Colors[three.active] = vector(shades.field_active);
  }
  style.Colors[ImGuiCol_Header] = vector(shades.accent, 0.25f);
  style.Colors[ImGuiCol_HeaderHovered] = vector(shades.field_hovered);
  style.Colors[ImGuiCol_HeaderActive] = vector(shades.field_active);
}

}  // namespace

void set_style(Theme theme, double scale) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  set_sizes(style);
  const Shades& shades = shades_of(theme);
  set_text(style, shades);
  set_surfaces(style, shades);
  set_frames(style, shades);
  style.ScaleAllSizes(static_cast<float>(scale));
}

Palette palette_of(Theme theme) {
  const Shades& shades = shades_of(theme);
  return {colour(shades.ground), colour(shades.panel), colour(shades.line),
          colour(shades.text),   colour(shades.faint), colour(shades.accent)};
}

}  // namespace pillarfield::viewer
