#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"

namespace pillarfield::viewer {
namespace {

/// Writes columns from the left: a faint label, then its value, right-aligned in a fixed width.
class Row {
 public:
  void add(const char* label, const std::string& value, const char* widest) {
    const float width = ImGui::CalcTextSize(widest).x;
    full_ |= x_ + ImGui::CalcTextSize(label).x + gap() * 0.4f + width > right();
    if (full_) return;
    write(label, ImGuiCol_TextDisabled);
    x_ += gap() * 0.4f + width - ImGui::CalcTextSize(value.c_str()).x;
    write(value.c_str(), ImGuiCol_Text);
    x_ += gap();
  }

  /// Writes text at the current position, whether it fits or not.
  void begin(const std::string& words, ImGuiCol colour) { write(words.c_str(), colour); }

  /// Writes text at the end of the row; false if it does not fit.
  bool finish(const std::string& words, ImGuiCol colour) {
    const float width = ImGui::CalcTextSize(words.c_str()).x;
    if (right() - width < x_) return false;
    x_ = right() - width;
    write(words.c_str(), colour);
    return true;
  }

 private:
  static float right() { return ImGui::GetWindowWidth() - ImGui::GetStyle().WindowPadding.x; }
  static float gap() { return 1.4f * ImGui::GetFontSize(); }

  void write(const char* words, ImGuiCol colour) {
    ImGui::SetCursorPosX(x_);
    ImGui::SetCursorPosY(0.5f * (ImGui::GetWindowHeight() - ImGui::GetFontSize()));
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetColorU32(colour));
    ImGui::TextUnformatted(words);
    ImGui::PopStyleColor();
    x_ += ImGui::CalcTextSize(words).x;
  }

  bool full_ = false;  ///< a column did not fit
  float x_ = ImGui::GetStyle().WindowPadding.x;
};

void add_measures(Row& row, const AppState& state) {
  const PlayerStatistics solved = state.source.player->statistics();
  const DrawStatistics& drawn = state.window.draw;
  row.add("solve", fmt::format("{:.0f} Hz", solved.produced_hz), "0000 Hz");
  row.add("", fmt::format("{:.1f} ms", solved.produce_ms_median), "000.0 ms");
  row.add("show", fmt::format("{:.0f} Hz", drawn.frames_hz), "000 Hz");
  row.add("draw", fmt::format("{:.1f} ms", drawn.draw_ms_median), "000.0 ms");
  row.add("latency", fmt::format("{:.1f} ms", drawn.latency_ms_median), "000.0 ms");
  row.add("not shown", fmt::format("{}", solved.not_shown), "00000");
  row.add("memory", drawn.in_place ? "in place" : "copied", "in place");
}

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

bool fits_beside_measures(const std::string& words) {
  const float measures = ImGui::CalcTextSize("0").x * 100;
  return ImGui::GetWindowWidth() > measures + ImGui::CalcTextSize(words.c_str()).x;
}

}  // namespace

void status_row(const AppState& state, const std::string& gpu) {
  Row row;
  const std::string& notice = state.window.notice;
  const bool fits = notice.empty() || fits_beside_measures(notice);
  if (fits && state.window.show_counters) add_measures(row, state);
  if (fits && !state.window.show_counters) row.begin(source_words(state), ImGuiCol_Text);
  if (!notice.empty()) {
    if (state.window.notice.is_failure)
      ImGui::PushStyleColor(ImGuiCol_CheckMark, packed(kWarningColour));
    if (!row.finish(notice, ImGuiCol_CheckMark)) row.begin(notice, ImGuiCol_CheckMark);
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
