#include <imgui.h>

#include "viewer/app/application.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/window/style.h"

// Drawing of an Application: its picture and when one is due.

namespace pillarfield::viewer {
namespace {

Presenter::Place place_in_window(const Viewport& area) {
  return {{static_cast<int>(area.x), static_cast<int>(area.y)}, extent_of(area)};
}

}  // namespace

bool Application::fit_to_window() {
  const vk::Extent2D size = window_.size();
  if (size.width == 0 || size.height == 0) return false;
  arrange();
  std::vector<Presenter::Place> places;
  if (shows_source()) places.push_back(place_in_window(place_.area));
  if (shows_source() && state_.beside != nullptr) {
    places.push_back(place_in_window(second_half(screen_.field)));
  }
  const bool fits = !presenter_.stale() && size == sized_for_ && places == presenter_.places() &&
                    scale() == presenter_.gui().scale();
  if (fits) return true;
  sized_for_ = size;
  drawn_settings_.reset();
  return presenter_.resize(size, places, scale());
}

/// Computes the layout for the current window.
void Application::arrange() {
  const vk::Extent2D size = window_.size();
  if (size.width == 0 || size.height == 0) return;
  state_.settings.scale = scale();
  state_.settings.colour_bar = state_.beside == nullptr;
  const Viewport before = place_.area;
  screen_ = divide(size.width, size.height, scale(), sides_of(state_));
  place_.area = state_.beside != nullptr ? first_half(screen_.field) : screen_.field;
  const bool moved = before.width != place_.area.width || before.height != place_.area.height;
  if (moved && state_.view_is_fitted && state_.player != nullptr) reset_view(state_, place_);
}

void Application::draw() {
  const double begin_s = Window::now_s();
  if (!shows_source()) {
    draw_page();
    static_cast<void>(presenter_.draw({}));
    redraws_.drawn(Window::now_s());
    return;
  }
  if (state_.hovered && !controls_.is_dragging()) controls_.hover(command());
  draw_front_frame();
  const bool new_settings = drawn_settings_ != state_.settings;
  const bool new_picture = state_.field && (field_is_new_ || new_settings);
  RenderSettings beside_settings = state_.settings;
  beside_settings.colour_bar = true;
  std::vector<std::optional<Presenter::Picture>> pictures(presenter_.places().size());
  if (new_picture) {
    pictures[0].emplace(Presenter::Picture{*state_.field, *place_.source, state_.settings});
  }
  if (pictures.size() > 1 && state_.beside_field && (beside_is_new_ || new_settings)) {
    pictures[1].emplace(
        Presenter::Picture{*state_.beside_field, state_.beside->info(), beside_settings});
  }
  if (!presenter_.draw(pictures)) return;
  // Not before there is something to see, for who waits for it.
  if (new_picture && !drawn_settings_) window_.set_title(place_.source->name + " – Pillarfield");
  measure(begin_s, new_picture);
  if (new_picture) drawn_settings_ = state_.settings;
  field_is_new_ = false;
  beside_is_new_ = false;
  watch_notice();
  if (writer_ != nullptr && writer_->wants_picture()) continue_frames();
}

void Application::draw_front_frame() {
  begin_gui_frame();
  draw_gui(command(), screen_, device_.name());
  ImGui::Render();
}

/// The page without a source.
void Application::draw_page() {
  begin_gui_frame();
  const vk::Extent2D size = presenter_.size();
  const Viewport all{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
  if (loading_ != nullptr) {
    const std::string name = loading_->options().source.filename().string();
    loading_page(name, loading_->message(), all);
  } else {
    choices_.pictures = presenter_.gui().pictures();
    const std::string chosen = start_page(choices_, all, state_.notice, scale());
    if (!chosen.empty()) pending_.open = chosen;
  }
  ImGui::Render();
}

void Application::begin_gui_frame() {
  presenter_.gui().use();
  set_style(state_.settings.theme, scale());
  const double now_s = Window::now_s();
  gui_input_.begin_frame(now_s - last_frame_s_);
  last_frame_s_ = now_s;
  const vk::Extent2D size = presenter_.size();
  ImGui::GetIO().DisplaySize =
      ImVec2(static_cast<float>(size.width), static_cast<float>(size.height));
  ImGui::NewFrame();
}

void Application::measure(double begin_s, bool new_picture) {
  const double now_s = Window::now_s();
  std::optional<double> latency_ms;
  // From the arrival at a sensor, else from the solved field; the first may precede on_new_field().
  if (new_picture && field_is_new_ && state_.field->arrived) {
    latency_ms = 1e3 * (steady_s() - std::chrono::duration<double>(*state_.field->arrived).count());
  } else if (new_picture && field_is_new_ && taken_s_ > 0) {
    latency_ms = 1e3 * (steady_s() - taken_s_);
  }
  clock_.add(now_s, 1e3 * (now_s - begin_s), latency_ms);
  state_.draw = clock_.lately(now_s);
  const FieldMemory& memory = presenter_.renderer().memory();
  state_.draw.in_place = memory.fields_in_place() > 0 && memory.bytes_copied() == 0;
  redraws_.drawn(now_s);
}

void Application::watch_notice() {
  const double now_s = Window::now_s();
  if (state_.notice != last_notice_) redraws_.notice(now_s);
  if (redraws_.notice_is_old(now_s)) {
    state_.notice.clear();
    redraws_.forget_notice();
    redraws_.field();
  }
  last_notice_.assign(state_.notice);
}

}  // namespace pillarfield::viewer
