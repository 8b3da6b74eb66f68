#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>

#include "pillarfield/printable.h"
#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/source/file_list.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
namespace {

/// "12.3 kB".
std::string size_of_file(std::uintmax_t bytes) {
  constexpr std::array kUnits{"B", "kB", "MB", "GB", "TB"};
  auto size = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; size >= 1000 && unit + 1 < kUnits.size(); ++unit) size /= 1000;
  return fmt::format("{} {}", three_digits(size), kUnits.at(unit));
}

/// Scrolls the table so that the marked line is in sight.
void show_marked(const FileList& files, float line) {
  const float top = line * static_cast<float>(files.marked());
  const float height = ImGui::GetWindowHeight() - line;
  if (top < ImGui::GetScrollY()) ImGui::SetScrollY(top);
  if (top > ImGui::GetScrollY() + height - line) ImGui::SetScrollY(top - height + line);
}

/// Returns true if the line is clicked.
bool file_line(const FileList::Entry& entry, bool marked) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  const std::string name = printable(entry.name) + (entry.is_folder ? "/" : "");
  if (entry.is_folder) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(ImGuiCol_CheckMark));
  const bool clicked = ImGui::Selectable(name.c_str(), marked, ImGuiSelectableFlags_SpanAllColumns);
  if (entry.is_folder) ImGui::PopStyleColor();
  ImGui::TableNextColumn();
  if (!entry.is_folder) ImGui::TextDisabled("%s", size_of_file(entry.bytes).c_str());
  return clicked;
}

std::optional<std::size_t> file_table(FileList& files) {
  constexpr int kFlags =
      ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_NoPadOuterX;
  if (!ImGui::BeginTable("files", 2, kFlags)) return std::nullopt;
  const float line = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("size", ImGuiTableColumnFlags_WidthFixed,
                          static_cast<float>(width_of("0000 kB ")));
  if (files.take_moved()) show_marked(files, line);
  std::optional<std::size_t> clicked;
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(files.entries().size()), line);
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const auto place = static_cast<std::size_t>(i);
      ImGui::PushID(i);
      if (file_line(files.entries()[place], place == files.marked())) clicked = place;
      ImGui::PopID();
    }
  }
  ImGui::EndTable();
  return clicked;
}

}  // namespace

StartAction file_page(FileList& files, const Viewport& area, double scale) {
  begin_page("files", area, scale);
  StartAction action;
  if (ImGui::Button("Back")) action.back = true;
  ImGui::SameLine();
  ImGui::TextDisabled(
      "↑ ↓ or a letter choose, Enter opens, Backspace: the folder above, Esc: back");
  ImGui::TextWrapped("%s", printable(files.folder().string()).c_str());
  if (!files.failure().empty()) warning_words(files.failure());
  if (const auto clicked = file_table(files)) {
    if (const auto file = files.open(*clicked)) action.open = file->string();
  }
  ImGui::End();
  return action;
}

}  // namespace pillarfield::viewer
