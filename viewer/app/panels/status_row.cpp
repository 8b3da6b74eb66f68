#include <fmt/format.h>
#include <imgui.h>

#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"

namespace pillarfield::viewer {
namespace {

/// Writes text from the left, and at the right end of the row.
class Row {
 public:
  /// Writes text, in as many lines as it needs if it `wraps`.
  void write(const std::string& words, ImGuiCol colour, bool wraps = false) {
    const float width = wraps ? right() - x_ : -1;
    const ImVec2 size = ImGui::CalcTextSize(words.c_str(), nullptr, false, width);
    ImGui::SetCursorPos(ImVec2(x_, 0.5f * (ImGui::GetWindowHeight() - size.y)));
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(colour));
    ImGui::PushTextWrapPos(wraps ? right() : -1);
    ImGui::TextUnformatted(words.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    x_ += size.x;
  }

  /// Writes text at the end of the row; false if it does not fit.
  bool finish(const std::string& words, ImGuiCol colour) {
    const float width = ImGui::CalcTextSize(words.c_str()).x;
    if (right() - width < x_) return false;
    x_ = right() - width;
    write(words, colour);
    return true;
  }

 private:
  static float right() { return ImGui::GetWindowWidth() - ImGui::GetStyle().WindowPadding.x; }

  float x_ = ImGui::GetStyle().WindowPadding.x;
};

std::string plural(std::uint64_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// State of a sensor in words for its user.
std::string sensor_words(const LiveStatus& status) {
  if (status.ended) return "the source has ended";
  const std::string& mismatch = status.health.stream.mismatch;
  if (status.health.since_frame_s > kSilentSeconds) {
    return silent_words(status) + (mismatch.empty() ? "" : ": " + mismatch);
  }
  std::string words = fmt::format("{:.0f} Hz", status.health.stream.rate_hz);
  if (status.health.stream.lost > 0)
    words += "   " + plural(status.health.stream.lost, "frame") + " lost";
  if (!status.recording.empty()) {
    words += "   recording " + recorded_words(status.recorded);
  }
  return words;
}

std::string source_words(const AppState& state) {
  Player& player = *state.source.player;
  const Skin& skin = player.info().skin;
  const std::string size =
      fmt::format("{} × {} {}", skin.element_rows(), skin.element_cols(), name_of(skin.layout));
  if (LiveControl* const live = player.live()) {
    return fmt::format("{}   {}", sensor_words(live->status()), size);
  }
  return fmt::format("{} at {:.6g} Hz   {}", plural(player.state().frames, "frame"),
                     player.state().rate_hz, size);
}

}  // namespace

void status_row(const AppState& state, const std::string& gpu) {
  Row row;
  const std::string& notice = state.window.notice;
  const bool fits = width_of(notice) + width_of(source_words(state)) <
                    static_cast<double>(ImGui::GetWindowWidth()) - 4 * ImGui::GetFontSize();
  if (fits || notice.empty()) row.write(source_words(state), ImGuiCol_Text);
  if (!notice.empty()) {
    if (state.window.notice.is_failure)
      ImGui::PushStyleColor(ImGuiCol_CheckMark, packed(kWarningColour));
    if (!row.finish(notice, ImGuiCol_CheckMark)) row.write(notice, ImGuiCol_CheckMark, true);
    if (state.window.notice.is_failure) ImGui::PopStyleColor();
    return;
  }
  const std::string& solver = state.source.player->info().solver;
  if (!row.finish(fmt::format("{}  ·  {}", solver, gpu), ImGuiCol_TextDisabled)) {
    row.finish(gpu, ImGuiCol_TextDisabled);
  }
  if (ImGui::IsWindowHovered()) {
    ImGui::SetTooltip("solved: %s\ndrawn: %s", solver.c_str(), gpu.c_str());
  }
}

}  // namespace pillarfield::viewer
