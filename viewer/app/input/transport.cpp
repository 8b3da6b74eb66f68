#include "viewer/app/input/transport.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "viewer/app/input/changes.h"
#include "viewer/app/panels/widgets.h"

namespace pillarfield::viewer {
namespace {

/// Text in the middle of the row's height, in a place `width` wide, so that nothing moves with it;
/// of the room that is left over, `share_left` is left of it.
void text_in(const std::string& text, float width, float share_left) {
  const float side = std::round(ImGui::GetFontSize() * 2);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float left = corner.x + share_left * (width - size.x);
  ImGui::GetWindowDrawList()->AddText(
      ImVec2(std::round(left), std::round(corner.y + (side - size.y) / 2)),
      ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
  ImGui::Dummy(ImVec2(width, side));
}

void play_buttons(Player& player, const PlayerState& state) {
  if (sign_button("back", sign::step_back, false, "One frame back (←)")) player.step(-1);
  ImGui::SameLine(0, 0);
  if (sign_button("play", state.playing ? sign::pause : sign::play, false,
                  "Play or pause (Space)")) {
    state.playing ? player.pause() : player.play();
  }
  ImGui::SameLine(0, 0);
  if (sign_button("on", sign::step_on, false, "One frame on (→)")) player.step(1);
}

void speed_buttons(Session& session, const PlayerState& state) {
  if (sign_button("slower", sign::less, false, "Slower (−)")) change_speed(session, -1);
  ImGui::SameLine(0, 0);
  text_in(fmt::format("{:g}×", state.speed), ImGui::CalcTextSize("0.05×").x, 0.5f);
  ImGui::SameLine(0, 0);
  if (sign_button("faster", sign::more, false, "Faster (+)")) change_speed(session, 1);
}

void mode_buttons(Session& session, const PlayerState& state) {
  Player& player = *session.player;
  if (sign_button("loop", sign::loop, state.loops, "Loop (L)")) player.set_loop(!state.loops);
  ImGui::SameLine(0, 2);
  if (sign_button("follow", sign::follow, state.follows, "Follow the newest frame (F)")) {
    player.set_follow(!state.follows);
  }
  ImGui::SameLine(0, 2);
  if (sign_button("help", sign::question, session.show_help, "Keys and mouse (?)")) {
    session.show_help = !session.show_help;
  }
}

/// Where the head is, as a line to pull it along.
void scrub(Player& player, const PlayerState& state, std::uint64_t shown, float width) {
  const float side = std::round(ImGui::GetFontSize() * 2);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("scrub", ImVec2(width, side));
  const float knob = 0.32f * ImGui::GetFontSize();
  const float begin = corner.x + knob;
  const float length = std::max(width - 2 * knob, 1.0f);
  const auto last = static_cast<float>(std::max<std::uint64_t>(state.frames - 1, 1));
  if (ImGui::IsItemActive()) {
    const float share = std::clamp((ImGui::GetIO().MousePos.x - begin) / length, 0.0f, 1.0f);
    const auto frame = static_cast<std::uint64_t>(std::lround(share * last));
    if (frame != state.frame) player.seek(frame);
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = std::round(corner.y + side / 2);
  const float thick = std::max(std::round(0.1f * ImGui::GetFontSize()), 1.0f);
  // Pulled, the knob is where the hand is; else it tells what is on display.
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

std::string time_text(const Session& session, const PlayerState& state, std::uint64_t shown) {
  const double time = session.field ? session.field->time_s : 0;
  return fmt::format("{:.3f} s   {} / {}", time, shown + 1, state.frames);
}

}  // namespace

void transport(const Command& command) {
  Session& session = command.session;
  Player& player = *session.player;
  const PlayerState state = player.state();
  const std::uint64_t shown = session.field ? session.field->index : state.frame;
  const float side = std::round(ImGui::GetFontSize() * 2);
  const float gap = ImGui::GetFontSize();
  const std::string widest = fmt::format("0000.000 s   {0} / {0}", state.frames);
  const float time_width = ImGui::CalcTextSize(widest.c_str()).x;
  const float speed_width = 2 * side + ImGui::CalcTextSize("0.05×").x;
  // A narrow window has no room for everything: where the head is comes last to go.
  const float least = 8 * side + 4 + 3 * gap;
  const float room = ImGui::GetContentRegionAvail().x;
  const bool has_time = room > least + time_width;
  const bool has_speed = room > least + time_width + speed_width;
  const float rest = (has_time ? time_width + gap / 2 : 0) + (has_speed ? speed_width + gap : 0) +
                     3 * side + 4 + gap + gap / 2;

  play_buttons(player, state);
  ImGui::SameLine(0, gap / 2);
  scrub(player, state, shown, std::max(ImGui::GetContentRegionAvail().x - rest, 2 * side));
  if (has_time) {
    ImGui::SameLine(0, gap / 2);
    text_in(time_text(session, state, shown), time_width, 1);
  }
  if (has_speed) {
    ImGui::SameLine(0, gap);
    speed_buttons(session, state);
  }
  ImGui::SameLine(0, gap);
  mode_buttons(session, state);
}

}  // namespace pillarfield::viewer
