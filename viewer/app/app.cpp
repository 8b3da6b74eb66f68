#include "viewer/app/app.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/processor.h"
#include "viewer/app/application.h"

namespace pillarfield::viewer {
namespace {

/// The first use of OpenCL sets the environment, so it comes before all threads.
void prepare_devices() {
  try {
    static_cast<void>(list_devices());
  } catch (const Error&) {
    // Opening a device fails with the same error, where one is needed.
  }
}

}  // namespace

Application::Application(const Options& options)
    : options_(options),
      choices_{user_.recent(), scenes_at_hand(), {}},
      window_("Pillarfield", options.width, options.height),
      instance_(Window::extensions(), options.validate),
      surface_(window_.make_surface(instance_)),
      device_(instance_, {options.gpu, *surface_, !options.copy_fields}),
      presenter_(instance_, device_, *surface_, scale()) {
  state_.settings.theme = options.look.theme;
}

void Application::run() {
  window_.show();
  source_was_given_ = !options_.source.empty();
  if (source_was_given_) open(options_.source.string());
  while (!window_.closes() && !pending_.quit && !is_interrupted()) {
    wait();
    take_loaded();
    take_input();
    take_news();
    take_newest_field();
    if (redraws_.due(Window::now_s()) && fit_to_window()) draw();
    serve();
  }
  user_.save();
  if (options_.statistics) print_statistics();
  loading_.reset();
}

/// Waits for events; briefly, since a signal does not end a wait.
void Application::wait() {
  constexpr double kLongestWaitS = 0.25;
  const bool minimised = window_.size().width == 0;
  const auto rest = redraws_.rest(Window::now_s());
  if (minimised) {
    window_.wait(kLongestWaitS);
  } else if (rest && *rest <= 0) {
    window_.poll();
  } else {
    window_.wait(std::min(rest.value_or(kLongestWaitS), kLongestWaitS));
  }
}

void Application::take_input() {
  const bool damaged = window_.take_damage();
  const auto events = window_.take_events();
  if (damaged || !events.empty()) redraws_.input(Window::now_s());
  presenter_.gui().use();
  arrange();
  for (const InputEvent& event : events) route(event);
  const auto drops = window_.take_drops();
  if (!drops.empty()) pending_.open = drops.front();
}

/// Sends an event to the controls or to ImGui. Text input suppresses shortcuts; popups take the
/// mouse.
void Application::route(const InputEvent& event) {
  if (!shows_source()) return route_to_start_page(event);
  if (const auto* key = std::get_if<KeyEvent>(&event)) return route_key(*key);
  if (std::holds_alternative<TextEvent>(event)) {
    if (ImGui::GetIO().WantTextInput) gui_input_.take(event);
    return;
  }
  const bool covered = GuiInput::has_open_list();
  const auto* const button = std::get_if<ButtonEvent>(&event);
  const bool presses = button != nullptr && button->pressed;
  const auto* const wheel = std::get_if<WheelEvent>(&event);
  if (state_.show_help && (presses || wheel != nullptr)) {  // The help scrolls, or goes.
    if (wheel != nullptr || contains(state_.help_place, button->pixel))
      return gui_input_.take(event);
    state_.show_help = false;
    return;
  }
  const bool in_field = wheel != nullptr && contains(screen_.field, wheel->pixel) && !covered;
  if (!in_field) gui_input_.take(event);
  if (!covered || (button != nullptr && !presses)) {
    controls_.take(in_first_half(event), command());
  }
}

void Application::route_to_start_page(const InputEvent& event) {
  gui_input_.take(event);
  const auto* const key = std::get_if<KeyEvent>(&event);
  if (key == nullptr || !key->pressed || key->unusable || ImGui::GetIO().WantTextInput) return;
  if (key->key == GLFW_KEY_ESCAPE && state_.player != nullptr) at_start_ = false;
  if (key->key == GLFW_KEY_Q) pending_.quit = true;
}

/// Covers the source, which goes on, by the start page.
void Application::show_start_page() {
  at_start_ = true;
  choices_.recent = user_.recent();
  state_.notice.clear();
}

void Application::route_key(const KeyEvent& key) {
  const bool types = ImGui::GetIO().WantTextInput;
  if (types || !key.pressed) gui_input_.take(key);
  if (key.pressed && GuiInput::has_open_list()) {
    GuiInput::close_lists();
  } else if (!types) {
    controls_.take(key, command());
  }
}

/// The second picture has the view of the first, so a place in it means the one in the first.
InputEvent Application::in_first_half(InputEvent event) const {
  if (state_.beside == nullptr) return event;
  const Viewport second = second_half(screen_.field);
  std::visit(
      [&](auto& each) {
        if constexpr (requires { each.pixel; }) {
          if (contains(second, each.pixel)) each.pixel.x -= second.x - screen_.field.x;
        }
      },
      event);
  return event;
}

void Application::take_newest_field() {
  if (!shows_source()) return;
  if (!held_) {
    taken_s_ = produced_s_;
    held_ = taken_field();
    if (held_ && state_.beside != nullptr) state_.beside->seek(held_->index);
  }
  take_beside();
  if (!held_ || !is_in_step()) return;
  take_field(state_, *std::exchange(held_, std::nullopt));
  load_follower_.take_field(state_);
  field_is_new_ = true;
  redraws_.field();
}

/// True once the second source shows the frame of the one that is held.
bool Application::is_in_step() const {
  if (state_.beside == nullptr || state_.beside->live() != nullptr) return true;
  const std::uint64_t last = state_.beside->info().frames - 1;
  return state_.beside_field && state_.beside_field->index == std::min(held_->index, last);
}

/// Progress of other threads, and of a sensor without frames.
void Application::take_news() {
  if (news_.exchange(false)) redraws_.field();
  if (!shows_source()) return;
  attend_survey();
  attend_sensor();
}

void Application::print_statistics() const {
  const PlayerStatistics played =
      state_.player == nullptr ? PlayerStatistics{} : state_.player->statistics();
  fmt::print(R"({{"frames":{},"draw_ms_median":{:.3f},"latency_ms_median":{:.3f},"produced":{},)"
             R"("taken":{},"not_shown":{},"in_place":{},"field":[{},{},{},{}],)"
             R"("validation_messages":{}}})"
             "\n",
             clock_.frames(), clock_.draw_ms_median(), clock_.latency_ms_median(), played.produced,
             played.taken, played.not_shown, state_.draw.in_place, screen_.field.x, screen_.field.y,
             screen_.field.width, screen_.field.height, instance_.validation_messages());
}

int run_window(const Options& options) {
  prepare_devices();
  Application(options).run();
  return 0;
}

bool is_device_lost(const std::exception& error) {
  return dynamic_cast<const vk::DeviceLostError*>(&error) != nullptr;
}

}  // namespace pillarfield::viewer
