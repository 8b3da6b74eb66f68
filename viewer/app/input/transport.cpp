#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "viewer/app/input/actions.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/widgets.h"

namespace pillarfield::viewer {
namespace {

/// Text in a field of fixed `width`, centred vertically; `align` is 0 for left, 1 for right.
void text_in(const std::string& text, float width, float align) {
  const float side = std::round(ImGui::GetFontSize() * 2);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float left = corner.x + align * (width - size.x);
  ImGui::GetWindowDrawList()->AddText(
      ImVec2(std::round(left), std::round(corner.y + (side - size.y) / 2)),
      ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
  ImGui::Dummy(ImVec2(width, side));
}

void play_buttons(Player& player, const PlayerState& playback) {
  if (icon_button("back", icon::step_back, false, "One frame back (←)")) player.step(-1);
  ImGui::SameLine(0, 0);
  if (icon_button("play", playback.playing ? icon::pause : icon::play, false,
                  "Play or pause (Space)")) {
    playback.playing ? player.pause() : player.play();
  }
  ImGui::SameLine(0, 0);
  if (icon_button("on", icon::step_on, false, "One frame on (→)")) player.step(1);
}

void speed_buttons(AppState& state, const PlayerState& playback) {
  if (icon_button("slower", icon::less, false, "Slower (−)")) change_speed(state, -1);
  ImGui::SameLine(0, 0);
  text_in(fmt::format("{:g}×", playback.speed), ImGui::CalcTextSize("0.05×").x, 0.5f);
  ImGui::SameLine(0, 0);
  if (icon_button("faster", icon::more, false, "Faster (+)")) change_speed(state, 1);
}

void mode_buttons(AppState& state, const PlayerState& playback) {
  Player& player = *state.source.player;
  if (icon_button("loop", icon::loop, playback.loops, "Loop (L)")) player.set_loop(!playback.loops);
  ImGui::SameLine(0, 2);
  if (icon_button("follow", icon::follow, playback.follows, "Follow the newest frame (F)")) {
    player.set_follow(!playback.follows);
  }
  ImGui::SameLine(0, 2);
  if (icon_button("help", icon::question, state.window.show_help, "Keys and mouse (?)")) {
    state.window.show_help = !state.window.show_help;
  }
}

/// The play head's slider.
void scrub(Player& player, const PlayerState& playback, std::uint64_t shown, float width) {
  const float side = std::round(ImGui::GetFontSize() * 2);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("scrub", ImVec2(width, side));
  const float knob = 0.32f * ImGui::GetFontSize();
  const float begin = corner.x + knob;
  const float length = std::max(width - 2 * knob, 1.0f);
  const auto last = static_cast<float>(std::max<std::uint64_t>(playback.frames - 1, 1));
  if (ImGui::IsItemActive()) {
    const float share = std::clamp((ImGui::GetIO().MousePos.x - begin) / length, 0.0f, 1.0f);
    const auto frame = static_cast<std::uint64_t>(std::lround(share * last));
    if (frame != playback.frame) player.seek(frame);
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = std::round(corner.y + side / 2);
  const float thick = std::max(std::round(0.1f * ImGui::GetFontSize()), 1.0f);
  // While dragged, the knob shows the target; else the frame on display.
  const std::uint64_t at = ImGui::IsItemActive() ? player.state().frame : shown;
  const float x = begin + length * static_cast<float>(at) / last;
  list.AddRectFilled(ImVec2(begin, y - thick), ImVec2(begin + length, y + thick),
                     ImGui::GetColorU32(ImGuiCol_FrameBgActive), thick);
  list.AddRectFilled(ImVec2(begin, y - thick), ImVec2(x, y + thick),
                     ImGui::GetColorU32(ImGuiCol_SliderGrab), thick);
  const bool held = ImGui::IsItemHovered() || ImGui::IsItemActive();
  list.AddCircleFilled(ImVec2(x, y), held ? 1.25f * knob : knob,
                       ImGui::GetColorU32(ImGuiCol_SliderGrab));
}

std::string time_text(const AppState& state, const PlayerState& playback, std::uint64_t shown) {
  const double time = state.source.field ? state.source.field->time_s : 0;
  return fmt::format("{}   {} / {}", state.look.settings.units.fixed(Dimension::time, time, 3),
                     shown + 1, playback.frames);
}

/// Record and tare, where frames are solved here.
void sensor_icons(const Command& command, LiveControl& live, const LiveStatus& status) {
  const float gap = ImGui::GetFontSize();
  ImGui::SameLine(0, gap / 2);
  const bool records = !status.recording.empty();
  if (icon_button("record", icon::record, records, "Record the raw frames (Ctrl+R)")) {
    command.pending.record = true;
  }
  ImGui::SameLine(0, gap / 2);
  if (icon_button("tare", icon::tare, status.taring,
                  "Tare: the mean of the next half second becomes zero (Z)")) {
    live.tare();
  }
}

/// The row of a sensor: freeze, record, tare, and the time.
void live_transport(const Command& command, LiveControl& live) {
  AppState& state = command.state;
  Player& player = *state.source.player;
  const LiveStatus status = live.status();
  const bool playing = player.state().playing;
  const float gap = ImGui::GetFontSize();
  if (icon_button("play", playing ? icon::pause : icon::play, !playing,
                  "Freeze the picture, not the sensor (Space)")) {
    playing ? player.pause() : player.play();
  }
  if (player.info().has_readings) sensor_icons(command, live, status);
  ImGui::SameLine(0, gap);
  const std::string time = state.source.field
                               ? fmt::format("{}   frame {}",
                                             state.look.settings.units.fixed(
                                                 Dimension::time, state.source.field->time_s, 2),
                                             state.source.field->index + 1)
                               : "";
  const std::string words = status.ended                                   ? "ended"
                            : status.health.since_frame_s > kSilentSeconds ? silent_words(status)
                            : playing                                      ? "live"
                                                                           : "frozen";
  text_in(fmt::format("{}   {}", words, time), 10 * gap, 0);
  const float side = std::round(ImGui::GetFontSize() * 2);
  ImGui::SameLine(ImGui::GetWindowWidth() - side - ImGui::GetStyle().WindowPadding.x);
  if (icon_button("help", icon::question, state.window.show_help, "Keys and mouse (?)")) {
    state.window.show_help = !state.window.show_help;
  }
}

}  // namespace

void transport(const Command& command) {
  AppState& state = command.state;
  Player& player = *state.source.player;
  if (LiveControl* const live = player.live()) return live_transport(command, *live);
  const PlayerState playback = player.state();
  const std::uint64_t shown = state.source.field ? state.source.field->index : playback.frame;
  const float side = std::round(ImGui::GetFontSize() * 2);
  const float gap = ImGui::GetFontSize();
  const std::string widest = fmt::format("0000.000 s   {0} / {0}", playback.frames);
  const float time_width = ImGui::CalcTextSize(widest.c_str()).x;
  const float speed_width = 2 * side + ImGui::CalcTextSize("0.05×").x;
  // A narrow window drops the speed first, then the time.
  const float least = 8 * side + 4 + 3 * gap;
  const float available = ImGui::GetContentRegionAvail().x;
  const bool has_time = available > least + time_width;
  const bool has_speed = available > least + time_width + speed_width;
  const float rest = (has_time ? time_width + gap / 2 : 0) + (has_speed ? speed_width + gap : 0) +
                     3 * side + 4 + gap + gap / 2;

  play_buttons(player, playback);
  ImGui::SameLine(0, gap / 2);
  scrub(player, playback, shown, std::max(ImGui::GetContentRegionAvail().x - rest, 2 * side));
  if (has_time) {
    ImGui::SameLine(0, gap / 2);
    text_in(time_text(state, playback, shown), time_width, 1);
  }
  if (has_speed) {
    ImGui::SameLine(0, gap);
    speed_buttons(state, playback);
  }
  ImGui::SameLine(0, gap);
  mode_buttons(state, playback);
}

}  // namespace pillarfield::viewer
