#include <imgui.h>

#include <algorithm>
#include <array>

#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/window/docks.h"

namespace pillarfield::viewer {
namespace {

void begin_page(const char* name, const Viewport& area, float padding) {
  ImGui::SetNextWindowPos(to_imgui({area.x, area.y}));
  ImGui::SetNextWindowSize(to_imgui({area.width, area.height}));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, padding));
  ImGui::Begin(name, nullptr, fixed_window_flags());
  ImGui::PopStyleVar();
}

void caption(const char* words) {
  ImGui::Spacing();
  ImGui::TextDisabled("%s", words);
}

/// A list of sources in columns; returns the one that is clicked.
std::string source_list(const char* id, const std::vector<std::string>& sources,
                        const std::vector<std::string>& labels, int columns) {
  std::string chosen;
  if (!ImGui::BeginTable(id, columns)) return chosen;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    ImGui::TableNextColumn();
    if (ImGui::Selectable(labels[i].c_str())) chosen = sources[i];
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", sources[i].c_str());
  }
  ImGui::EndTable();
  return chosen;
}

std::string recent_list(const std::vector<std::string>& recent) {
  if (recent.empty()) return {};
  caption("Recent");
  return source_list("recent", recent, recent, 1);
}

std::string scene_list(const char* title, const std::vector<std::filesystem::path>& scenes) {
  if (scenes.empty()) return {};
  caption(title);
  std::vector<std::string> paths;
  std::vector<std::string> names;
  for (const auto& scene : scenes) {
    paths.push_back(scene.string());
    names.push_back(scene.stem().string());
  }
  return source_list(title, paths, names, 3);
}

std::string name_line() {
  static std::array<char, 4096> name{};
  caption("A file, or a sensor: udp:ADDRESS:PORT, shm:NAME, serial:DEVICE");
  ImGui::SetNextItemWidth(-100);
  const bool entered = ImGui::InputTextWithHint("##name", "udp:127.0.0.1:9870", name.data(),
                                                name.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  const bool pressed = ImGui::Button("Open", ImVec2(-1, 0));
  return entered || pressed ? std::string(name.data()) : std::string();
}

}  // namespace

std::string start_page(const StartChoices& choices, const Viewport& area, const std::string& notice,
                       double scale) {
  const auto room = static_cast<float>(std::max(0.5 * (area.width - 860 * scale), 24 * scale));
  begin_page("start", area, room);
  ImGui::SetCursorPosY(static_cast<float>(48 * scale));
  ImGui::TextUnformatted("Pillarfield");
  ImGui::TextDisabled("Choose a source, or drop a file onto the window.");
  if (!notice.empty()) {
    ImGui::Spacing();
    ImGui::PushStyleColor(ImGuiCol_Text, packed(colour_from(0xe69f00)));
    ImGui::TextWrapped("%s", notice.c_str());
    ImGui::PopStyleColor();
  }
  std::string chosen = name_line();
  for (const std::string& other :
       {recent_list(choices.recent),
        scene_list("Scenes, simulated as they are opened", choices.scenes.touches),
        scene_list("Recordings for pillarfield calibrate", choices.scenes.calibration)}) {
    if (chosen.empty()) chosen = other;
  }
  ImGui::End();
  return chosen;
}

void loading_page(const std::string& source, const std::string& message, const Viewport& area) {
  begin_page("loading", area, 0);
  const auto centred = [&](const std::string& words, double line, bool faint) {
    const ImVec2 size = ImGui::CalcTextSize(words.c_str());
    ImGui::SetCursorPos(
        ImVec2(std::max(0.5f * (static_cast<float>(area.width) - size.x), 8.0f),
               0.5f * static_cast<float>(area.height) + static_cast<float>(line) * 1.6f * size.y));
    if (faint) {
      ImGui::TextDisabled("%s", words.c_str());
    } else {
      ImGui::TextUnformatted(words.c_str());
    }
  };
  centred("Opening " + source, -1, false);
  centred(message.empty() ? "reading" : message, 0, true);
  ImGui::End();
}

}  // namespace pillarfield::viewer
