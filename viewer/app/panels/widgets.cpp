#include "viewer/app/panels/widgets.h"

#include <imgui.h>

#include <cmath>
#include <numbers>

namespace pillarfield::viewer {
namespace {

/// Background of a button.
ImU32 ground(bool lit, bool hovered, bool held) {
  if (held) return ImGui::GetColorU32(ImGuiCol_ButtonActive);
  if (hovered) return ImGui::GetColorU32(ImGuiCol_ButtonHovered);
  return lit ? ImGui::GetColorU32(ImGuiCol_Header) : 0;
}

void tip(const char* help) {
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help);
}

}  // namespace

Section section(const char* title) {
  ImGui::Spacing();
  ImGui::PushStyleColor(ImGuiCol_Header, 0);
  ImGui::PushStyleColor(ImGuiCol_HeaderHovered, 0);
  ImGui::PushStyleColor(ImGuiCol_HeaderActive, 0);
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_TextDisabled));
  const bool open = ImGui::CollapsingHeader(title);
  ImGui::PopStyleColor(4);
  constexpr float kLeastDrag = 8;
  const bool dragged =
      ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, kLeastDrag);
  const bool menu = ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Right);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("drag to move, right click for its place");
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(low.x, high.y), ImVec2(high.x, high.y + 1),
                                            ImGui::GetColorU32(ImGuiCol_Separator));
  if (open) ImGui::Spacing();
  return {open, dragged, menu};
}

void labelled(const char* label) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", label);
  ImGui::SameLine(ImGui::GetFontSize() * 6.2f);
  ImGui::SetNextItemWidth(-1);
}

bool toggle_group(const char* id, std::span<const char* const> words, int& chosen) {
  ImGui::PushID(id);
  const float gap = 1;
  const auto count = static_cast<float>(words.size());
  const float available = ImGui::GetContentRegionAvail().x;
  const float width = std::floor((available - gap * (count - 1)) / count);
  bool changed = false;
  for (int i = 0; i < static_cast<int>(words.size()); ++i) {
    if (i > 0) ImGui::SameLine(0, gap);
    const bool lit = i == chosen;
    if (lit) {
      ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetColorU32(ImGuiCol_Header));
    } else {
      ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_TextDisabled));
    }
    if (ImGui::Button(words[static_cast<std::size_t>(i)], ImVec2(width, 0)) && !lit) {
      chosen = i;
      changed = true;
    }
    ImGui::PopStyleColor();
  }
  ImGui::PopID();
  return changed;
}

bool icon_button(const char* id, Icon icon, bool lit, const char* help) {
  const float side = std::round(ImGui::GetFontSize() * 2);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::InvisibleButton(id, ImVec2(side, side));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 back = ground(lit, ImGui::IsItemHovered(), ImGui::IsItemActive());
  list.AddRectFilled(corner, ImVec2(corner.x + side, corner.y + side), back,
                     ImGui::GetStyle().FrameRounding);
  const ImU32 colour = ImGui::GetColorU32(lit ? ImGuiCol_CheckMark : ImGuiCol_Text);
  icon(list, ImVec2(corner.x + side / 2, corner.y + side / 2), side * 0.42f, colour);
  tip(help);
  return pressed;
}

namespace icon {
namespace {

/// A triangle that points right (`way` 1) or left (-1).
void triangle(ImDrawList& list, const ImVec2& middle, float width, float height, float way,
              unsigned colour) {
  const float back = middle.x - way * width / 2;
  const ImVec2 tip(middle.x + way * width / 2, middle.y);
  list.AddTriangleFilled(ImVec2(back, middle.y - height / 2), tip,
                         ImVec2(back, middle.y + height / 2), colour);
}

void box(ImDrawList& list, const ImVec2& middle, float width, float height, unsigned colour) {
  list.AddRectFilled(ImVec2(middle.x - width / 2, middle.y - height / 2),
                     ImVec2(middle.x + width / 2, middle.y + height / 2), colour);
}

void step(ImDrawList& list, const ImVec2& middle, float side, float way, unsigned colour) {
  triangle(list, ImVec2(middle.x + way * side * 0.12f, middle.y), side * 0.6f, side * 0.8f, way,
           colour);
  box(list, ImVec2(middle.x - way * side * 0.38f, middle.y), side * 0.16f, side * 0.8f, colour);
}

float stroke(float side) { return std::fmax(side * 0.13f, 1.0f); }

}  // namespace

void play(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  triangle(list, ImVec2(middle.x + side * 0.06f, middle.y), side * 0.9f, side, 1, colour);
}

void pause(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  for (const float way : {-1.0f, 1.0f}) {
    box(list, ImVec2(middle.x + way * side * 0.25f, middle.y), side * 0.26f, side * 0.95f, colour);
  }
}

void step_on(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  step(list, middle, side, 1, colour);
}

void step_back(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  step(list, middle, side, -1, colour);
}

void loop(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const float radius = side * 0.42f;
  list.PathArcTo(middle, radius, -0.15f * kPi, 1.45f * kPi, 24);
  list.PathStroke(colour, 0, stroke(side));
  const ImVec2 end(middle.x + side * 0.08f, middle.y - radius);
  triangle(list, end, side * 0.4f, side * 0.46f, 1, colour);
}

void follow(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  triangle(list, ImVec2(middle.x - side * 0.28f, middle.y), side * 0.5f, side * 0.8f, 1, colour);
  triangle(list, ImVec2(middle.x + side * 0.16f, middle.y), side * 0.5f, side * 0.8f, 1, colour);
  box(list, ImVec2(middle.x + side * 0.48f, middle.y), side * 0.14f, side * 0.8f, colour);
}

void less(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  box(list, middle, side * 0.75f, stroke(side), colour);
}

void more(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  box(list, middle, side * 0.75f, stroke(side), colour);
  box(list, middle, stroke(side), side * 0.75f, colour);
}

void record(ImDrawList& list, const ImVec2& middle, float side, unsigned /*colour*/) {
  list.AddCircleFilled(middle, side * 0.42f, IM_COL32(214, 60, 48, 255));
}

/// A zero.
void tare(ImDrawList& list, const ImVec2& middle, float side, unsigned colour) {
  const ImVec2 half(side * 0.28f, side * 0.45f);
  list.AddRect(ImVec2(middle.x - half.x, middle.y - half.y),
               ImVec2(middle.x + half.x, middle.y + half.y), colour, half.x, 0, stroke(side));
}

void question(ImDrawList& list, const ImVec2& middle, float /*side*/, unsigned colour) {
  const ImVec2 size = ImGui::CalcTextSize("?");
  list.AddText(ImVec2(std::round(middle.x - size.x / 2), std::round(middle.y - size.y / 2)), colour,
               "?");
}

}  // namespace icon
}  // namespace pillarfield::viewer
