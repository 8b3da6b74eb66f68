#include "viewer/app/window/style.h"

#include <imgui.h>

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

struct StyleColour {
  unsigned Shades::*shade = nullptr;
  int index = 0;
  float alpha = 1;
};

constexpr StyleColour kStyleColours[] = {{&Shades::text, ImGuiCol_Text},
                                         {&Shades::faint, ImGuiCol_TextDisabled},
                                         {&Shades::accent, ImGuiCol_TextSelectedBg, 0.35f},
                                         {&Shades::accent, ImGuiCol_CheckMark},
                                         {&Shades::accent, ImGuiCol_SliderGrab},
                                         {&Shades::accent, ImGuiCol_SliderGrabActive},
                                         {&Shades::panel, ImGuiCol_WindowBg},
                                         {&Shades::panel, ImGuiCol_ChildBg, 0},
                                         {&Shades::popup, ImGuiCol_PopupBg},
                                         {&Shades::line, ImGuiCol_Border},
                                         {&Shades::line, ImGuiCol_Separator},
                                         {&Shades::field, ImGuiCol_TableHeaderBg},
                                         {&Shades::line, ImGuiCol_TableBorderLight},
                                         {&Shades::line, ImGuiCol_TableBorderStrong},
                                         {&Shades::panel, ImGuiCol_ScrollbarBg, 0},
                                         {&Shades::field_active, ImGuiCol_ScrollbarGrab},
                                         {&Shades::faint, ImGuiCol_ScrollbarGrabHovered},
                                         {&Shades::faint, ImGuiCol_ScrollbarGrabActive},
                                         {&Shades::field, ImGuiCol_FrameBg},
                                         {&Shades::field_hovered, ImGuiCol_FrameBgHovered},
                                         {&Shades::field_active, ImGuiCol_FrameBgActive},
                                         {&Shades::field, ImGuiCol_Button},
                                         {&Shades::field_hovered, ImGuiCol_ButtonHovered},
                                         {&Shades::field_active, ImGuiCol_ButtonActive},
                                         {&Shades::accent, ImGuiCol_Header, 0.25f},
                                         {&Shades::field_hovered, ImGuiCol_HeaderHovered},
                                         {&Shades::field_active, ImGuiCol_HeaderActive}};

}  // namespace

void set_style(Theme theme, double scale) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  set_sizes(style);
  const Shades& shades = shades_of(theme);
  for (const auto& [shade, index, alpha] : kStyleColours) {
    style.Colors[index] = vector(shades.*shade, alpha);
  }
  style.ScaleAllSizes(static_cast<float>(scale));
}

Palette palette_of(Theme theme) {
  const Shades& shades = shades_of(theme);
  return {colour(shades.ground), colour(shades.panel), colour(shades.line),
          colour(shades.text),   colour(shades.faint), colour(shades.accent)};
}

}  // namespace pillarfield::viewer
