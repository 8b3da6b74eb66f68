#include <imgui.h>

#include <algorithm>
#include <string>

#include "viewer/app/input/shortcuts.h"
#include "viewer/app/panels/panels.h"

namespace pillarfield::viewer {
namespace {

constexpr float kKeyColumn = 5.8f;  ///< width of the keys, font sizes
constexpr float kBlock = 21.0f;     ///< width of a block of keys and descriptions

void line(const char* keys, const char* description) {
  ImGui::TextUnformatted(keys);
  ImGui::SameLine(kKeyColumn * ImGui::GetFontSize());
  ImGui::TextDisabled("%s", description);
}

void title(const char* words) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_CheckMark));
  ImGui::TextUnformatted(words);
  ImGui::PopStyleColor();
}

void group(ShortcutGroup shown, const SourceInfo& source) {
  title(title_of(shown));
  for (const Shortcut& shortcut : shortcuts()) {
    if (shortcut.group == shown && applies(shortcut, source))
      line(shortcut.keys, shortcut.description);
  }
  ImGui::Spacing();
  ImGui::Spacing();
}

void mouse() {
  title("Mouse in the field");
  for (const MouseHelp& help : mouse_help()) {
    ImGui::TextUnformatted(help.gesture);
    const float indent = ImGui::GetFontSize();
    ImGui::Indent(indent);
    ImGui::TextDisabled("%s", help.description);
    ImGui::Unindent(indent);
  }
}

}  // namespace

Viewport help_overlay(const Viewport& area, const SourceInfo& source) {
  constexpr int kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                         ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                         ImGuiWindowFlags_HorizontalScrollbar;
  const ImVec2 middle(static_cast<float>(area.x + area.width / 2),
                      static_cast<float>(area.y + area.height / 2));
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowSizeConstraints(
      ImVec2(0, 0), ImVec2(static_cast<float>(area.width), static_cast<float>(area.height)));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetColorU32(ImGuiCol_PopupBg));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 4);
  const float em = ImGui::GetFontSize();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(1.6f * em, 1.3f * em));
  if (ImGui::Begin("help", nullptr, kFlags)) {
    ImGui::BeginGroup();
    group(ShortcutGroup::play, source);
    group(ShortcutGroup::view, source);
    ImGui::EndGroup();
    ImGui::SameLine(kBlock * em);
    ImGui::BeginGroup();
    group(ShortcutGroup::show, source);
    group(ShortcutGroup::write, source);
    group(ShortcutGroup::mark, source);
    ImGui::EndGroup();
    ImGui::SameLine(2 * kBlock * em);
    ImGui::BeginGroup();
    mouse();
    ImGui::EndGroup();
  }
  const ImVec2 corner = ImGui::GetWindowPos();
  const ImVec2 size = ImGui::GetWindowSize();
  ImGui::End();
  ImGui::PopStyleVar(3);
  ImGui::PopStyleColor();
  return {static_cast<double>(corner.x), static_cast<double>(corner.y), static_cast<double>(size.x),
          static_cast<double>(size.y)};
}

}  // namespace pillarfield::viewer
