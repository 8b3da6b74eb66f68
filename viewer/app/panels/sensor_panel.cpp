#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "viewer/app/input/actions.h"
#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/widgets.h"

namespace pillarfield::viewer {
namespace {

void count_line(std::vector<ShownValue>& lines, const char* label, std::uint64_t count) {
  if (count > 0) lines.push_back({label, fmt::format("{}", count), {}, ""});
}

/// Rate and losses; counts that are zero are left out, but for lost frames.
std::vector<ShownValue> health_lines(const LiveStatus& status) {
  const StreamHealth& stream = status.health.stream;
  std::vector<ShownValue> lines{{"rate", fmt::format("{:.1f}", stream.rate_hz), {}, "Hz"},
                                {"frames", fmt::format("{}", status.health.solved), {}, ""},
                                {"lost", fmt::format("{}", stream.lost), {}, ""}};
  count_line(lines, "program too late", stream.overrun);
  count_line(lines, "incomplete", stream.incomplete);
  count_line(lines, "late", stream.late);
  count_line(lines, "duplicates", stream.duplicates);
  count_line(lines, "reordered", stream.reordered);
  count_line(lines, "invalid", stream.invalid);
  count_line(lines, "restarts", stream.restarts);
  count_line(lines, "clock jumps", stream.clock_jumps);
  count_line(lines, "dead sensels", status.health.dead);
  count_line(lines, "stuck sensels", status.health.stuck);
  count_line(lines, "drifting sensels", status.health.drifting);
  return lines;
}

std::string state_words(const LiveStatus& status) {
  if (status.ended) return "the source has ended";
  if (status.health.since_frame_s > kSilentSeconds) return silent_words(status);
  return fmt::format("newest frame {:.0f} ms old", 1e3 * status.health.since_frame_s);
}

/// Record and tare, where frames are solved here.
void sensor_buttons(const Command& command, LiveControl& live, const LiveStatus& status) {
  const float half = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  const bool records = !status.recording.empty();
  if (ImGui::Button(records ? "Stop recording" : "Record", ImVec2(half, 0))) {
    command.pending.record = true;
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("Record the raw frames (Ctrl+R)");
  ImGui::SameLine();
  if (ImGui::Button(status.taring ? "Measuring ..." : "Tare", ImVec2(half, 0))) live.tare();
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("Tare, noise and threshold from the next half second; touch nothing (Z)");
  }
}

}  // namespace

std::string silent_words(const LiveStatus& status) {
  return fmt::format("no frames for {:.0f} s", status.health.since_frame_s);
}

double silence_s(const AppState& state) {
  LiveControl* const live = state.source.player->live();
  if (live == nullptr) return 0;
  const LiveStatus status = live->status();
  const bool silent = status.ended || status.health.since_frame_s > kSilentSeconds;
  return silent ? status.health.since_frame_s : 0;
}

void draw_silence(const AppState& state, const Viewport& field) {
  const double silent_s = silence_s(state);
  if (!(silent_s > 0)) return;
  const LiveStatus status = state.source.player->live()->status();
  const auto ago =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::duration<double>(silent_s));
  const std::time_t last =
      std::chrono::system_clock::to_time_t(std::chrono::system_clock::now() - ago);
  std::string words =
      fmt::format("{} {:%H:%M:%S}", status.ended ? "The source has ended, at" : "No frames since",
                  fmt::localtime(last));
  if (!status.ended && !status.health.stream.mismatch.empty()) {
    words += "\n" + status.health.stream.mismatch;
  }
  const PanelStyle style = panel_style(state.look.settings.scale);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  draw_block(list, field, with_alpha(style.ground, 0.6));
  const ImVec2 size = ImGui::CalcTextSize(words.c_str());
  const double gap = 10 * style.unit;
  const Viewport sign{field.x + 0.5 * (field.width - static_cast<double>(size.x)) - gap,
                      field.y + 0.25 * field.height - gap, static_cast<double>(size.x) + 2 * gap,
                      static_cast<double>(size.y) + 2 * gap};
  draw_block(list, sign, style.raised);
  draw_text(list, {sign.x + gap, sign.y + gap}, packed(kWarningColour), words);
}

void sensor_panel(const Command& command) {
  const PanelStyle style = panel_style(command.state.look.settings.scale);
  LiveControl* const live = command.state.source.player->live();
  if (live == nullptr) return;
  const LiveStatus status = live->status();
  if (command.state.source.player->info().has_readings) sensor_buttons(command, *live, status);
  faint_text(style, state_words(status).c_str());
  if (!status.recording.empty()) {
    const std::string name = std::filesystem::path(status.recording).filename().string();
    faint_text(style, fmt::format("{}: {}", name, recorded_words(status.recorded)).c_str());
  }
  if (!status.health.stream.mismatch.empty()) {
    faint_text(style, status.health.stream.mismatch.c_str());
  }
  if (!status.health.coverage.empty()) {
    faint_text(style,
               "Press Tare while nothing touches the skin: nearly all of it reads as touched.");
  }
  value_table(style, health_lines(status));
}

}  // namespace pillarfield::viewer
