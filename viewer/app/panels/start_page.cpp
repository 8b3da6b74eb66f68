#include <imgui.h>

#include <algorithm>
#include <array>

#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/window/gui.h"

namespace pillarfield::viewer {
namespace {

constexpr double kStartPageWidth = 860;  ///< nominal pixels

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
  std::vector<std::string> paths;
  std::vector<std::string> names;
  for (const auto& scene : scenes) {
    paths.push_back(scene.string());
    names.push_back(scene.stem().string());
  }
  if (paths.empty()) return {};
  caption(title);
  return source_list(title, paths, names, 4);
}

/// Returns the name that is entered.
std::string name_line() {
  static std::array<char, 4096> name{};
  caption("A file, or a sensor: udp:ADDRESS:PORT, shm:NAME, serial:DEVICE");
  const float button = 6 * ImGui::GetFontSize();
  ImGui::SetNextItemWidth(-button - ImGui::GetStyle().ItemSpacing.x);
  const bool entered = ImGui::InputTextWithHint("##name", "udp:127.0.0.1:9870", name.data(),
                                                name.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  const bool pressed = ImGui::Button("Open", ImVec2(button, 0));
  return entered || pressed ? name.data() : "";
}

/// A line that cannot be overlooked.
void warning_words(const std::string& words) {
  ImGui::Spacing();
  ImGui::PushStyleColor(ImGuiCol_Text, packed(kWarningColour));
  ImGui::TextWrapped("%s", words.c_str());
  ImGui::PopStyleColor();
}

}  // namespace

std::string start_page(const StartChoices& choices, const Viewport& area, const std::string& notice,
                       double scale) {
  const double side = std::max(0.5 * (area.width - kStartPageWidth * scale), 24 * scale);
  ImGui::SetNextWindowPos(to_imgui({area.x, area.y}));
  ImGui::SetNextWindowSize(to_imgui({area.width, area.height}));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, to_imgui({side, 24 * scale}));
  ImGui::Begin("start", nullptr, fixed_window_flags());
  ImGui::PopStyleVar();
  ImGui::TextUnformatted("Pillarfield");
  ImGui::TextDisabled("Choose a source, or drop a file onto the window.");
  if (!notice.empty()) warning_words(notice);
  ImGui::Spacing();
  std::string chosen;
  for (const std::string& each :
       {name_line(), recent_list(choices.recent),
        scene_list("Scenes, simulated as they are opened", choices.scenes)}) {
    if (chosen.empty()) chosen = each;
  }
  ImGui::End();
  return chosen;
}

void loading_page(const std::string& source, const std::string& message, const Viewport& area) {
  ImGui::SetNextWindowPos(to_imgui({area.x, area.y}));
  ImGui::SetNextWindowSize(to_imgui({area.width, area.height}));
  ImGui::Begin("loading", nullptr, fixed_window_flags());
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
