#include "viewer/app/input/gui_input.h"

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "viewer/render/imgui_point.h"

namespace pillarfield::viewer {
namespace {

#if IMGUI_VERSION_NUM < 18700
constexpr auto kKeypadEnter = ImGuiKey_KeyPadEnter;
#else
constexpr auto kKeypadEnter = ImGuiKey_KeypadEnter;
#endif

constexpr std::array kImGuiKeys{std::pair{ImGuiKey_Tab, GLFW_KEY_TAB},
                                std::pair{ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                std::pair{ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                std::pair{ImGuiKey_Home, GLFW_KEY_HOME},
                                std::pair{ImGuiKey_End, GLFW_KEY_END},
                                std::pair{ImGuiKey_Delete, GLFW_KEY_DELETE},
                                std::pair{ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                std::pair{ImGuiKey_Enter, GLFW_KEY_ENTER},
                                std::pair{ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                std::pair{kKeypadEnter, GLFW_KEY_KP_ENTER},
                                std::pair{ImGuiKey_A, GLFW_KEY_A},
                                std::pair{ImGuiKey_C, GLFW_KEY_C},
                                std::pair{ImGuiKey_V, GLFW_KEY_V},
                                std::pair{ImGuiKey_X, GLFW_KEY_X}};

void take_key(const KeyEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  if (event.key < 0 || event.key >= IM_ARRAYSIZE(io.KeysDown)) return;
  io.KeyCtrl = event.modifiers.control;
  io.KeyShift = event.modifiers.shift;
  io.KeysDown[event.key] = event.pressed;
}

void take_button(const ButtonEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = to_imgui(event.pixel);
  io.KeyCtrl = event.modifiers.control;
  io.KeyShift = event.modifiers.shift;
  io.MouseDown[static_cast<std::size_t>(event.button)] = event.pressed;
}

}  // namespace

void GuiInput::add(const std::vector<InputEvent>& events) {
  events_.insert(events_.end(), events.begin(), events.end());
}

bool GuiInput::has_pressed(int key) const {
  return std::ranges::any_of(events_, [&](const InputEvent& event) {
    const auto* const pressed = std::get_if<KeyEvent>(&event);
    return pressed != nullptr && pressed->pressed && !pressed->unusable && pressed->key == key;
  });
}

std::optional<InputEvent> GuiInput::next() {
  if (events_.empty()) return std::nullopt;
  const InputEvent event = events_.front();
  const auto* const button = std::get_if<ButtonEvent>(&event);
  const auto* const key = std::get_if<KeyEvent>(&event);
  const bool moves = std::holds_alternative<MotionEvent>(event) ||
                     std::holds_alternative<LeaveEvent>(event) ||
                     std::holds_alternative<WheelEvent>(event);
  // A key that repeats changes nothing, nor does one that is released outside a text.
  const bool changes =
      button != nullptr || (key != nullptr && (key->pressed ? key->key != held_ : wants_text()));
  const bool ends_drag = button != nullptr && !button->pressed && moved_;
  if ((changed_ && (changes || moves)) || ends_drag) return std::nullopt;
  changed_ |= changes;
  moved_ |= moves;
  if (key != nullptr && key->pressed) held_ = key->key;
  if (key != nullptr && !key->pressed && key->key == held_) held_ = 0;
  events_.pop_front();
  return event;
}

void GuiInput::take(const InputEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  if (const auto* key = std::get_if<KeyEvent>(&event)) {
    take_key(*key);
  } else if (const auto* text = std::get_if<TextEvent>(&event)) {
    io.AddInputCharacter(text->character);
  } else if (const auto* motion = std::get_if<MotionEvent>(&event)) {
    io.MousePos = to_imgui(motion->pixel);
  } else if (std::holds_alternative<LeaveEvent>(event)) {
    if (std::ranges::find(io.MouseDown, true) == std::end(io.MouseDown)) {
      io.MousePos = ImVec2(-1e6f, -1e6f);
    }
  } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
    take_button(*button);
  } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
    io.MouseWheel += static_cast<float>(wheel->steps);
  }
}

// ImGui's own word for it comes a frame late.
bool GuiInput::wants_text() {
  const ImGuiContext& gui = *ImGui::GetCurrentContext();
  return gui.ActiveId != 0 && gui.ActiveId == gui.InputTextState.ID;
}

bool GuiInput::has_open_list() {
  return ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

// ImGui closes popups by keys only with keyboard navigation, which is off.
void GuiInput::close_lists() {
  if (has_open_list()) ImGui::ClosePopupToLevel(0, true);
}

void GuiInput::begin_frame(double seconds_since_last) {
  ImGuiIO& io = ImGui::GetIO();
  for (const auto& [name, key] : kImGuiKeys) io.KeyMap[name] = key;
  changed_ = moved_ = false;
  io.DeltaTime = static_cast<float>(std::clamp(seconds_since_last, 1e-4, 0.1));
}

namespace {

void route_key(const KeyEvent& key, const Command& command, Controls& controls) {
  const bool types = GuiInput::wants_text();
  if (types || !key.pressed) GuiInput::take(key);
  if (key.pressed && GuiInput::has_open_list()) {
    GuiInput::close_lists();
  } else if (!types) {
    controls.take(key, command);
  }
}

}  // namespace

void route(const InputEvent& event, const Command& command, const Viewport& field,
           Controls& controls) {
  if (const auto* key = std::get_if<KeyEvent>(&event)) {
    return route_key(*key, command, controls);
  }
  if (std::holds_alternative<TextEvent>(event)) {
    if (GuiInput::wants_text()) GuiInput::take(event);
    return;
  }
  WindowState& window = command.state.window;
  const bool covered = GuiInput::has_open_list();
  const auto* const button = std::get_if<ButtonEvent>(&event);
  const bool presses = button != nullptr && button->pressed;
  const auto* const wheel = std::get_if<WheelEvent>(&event);
  if (window.show_help && (presses || wheel != nullptr)) {  // The help scrolls, or goes.
    if (wheel != nullptr || contains(window.help_place, button->pixel))
      return GuiInput::take(event);
    window.show_help = false;
    return;
  }
  const bool in_field = wheel != nullptr && contains(field, wheel->pixel) && !covered;
  if (!in_field) GuiInput::take(event);
  if (!covered || (button != nullptr && !presses)) {
    controls.take(event, command);
  }
}

}  // namespace pillarfield::viewer
