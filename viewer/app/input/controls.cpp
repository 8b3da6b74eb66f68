#include "viewer/app/input/controls.h"

#include <algorithm>
#include <cmath>

#include "viewer/app/input/actions.h"

namespace pillarfield::viewer {
namespace {

constexpr double kShake = 4;  ///< pixels at scale 1 that a click may move
constexpr double kZoomOfStep = 1.2;

double distance(Vec2 a, Vec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

double shake_of(const Command& command) { return kShake * command.state.look.settings.scale; }

/// The plot in pixels of the picture, which views use.
Viewport plot_of(const Command& command) {
  return layout_of(command.place.area.width, command.place.area.height, command.state.look.settings)
      .plot;
}

Vec2 in_picture(const Command& command, Vec2 pixel) {
  return {pixel.x - command.place.area.x, pixel.y - command.place.area.y};
}

/// After a move: clamps the view to the skin and detaches it from the window's size.
void settle(const Command& command) {
  keep_on_skin(command.state.look.settings.view, command.place.skin());
  command.state.look.view_is_fitted = false;
}

}  // namespace

void Controls::take(const InputEvent& event, const Command& command) {
  if (const auto* key = std::get_if<KeyEvent>(&event)) {
    if (key->pressed && !key->unusable) dispatch({key->key, key->modifiers}, command);
  } else if (const auto* motion = std::get_if<MotionEvent>(&event)) {
    move(motion->pixel, command);
  } else if (std::holds_alternative<LeaveEvent>(event)) {
    if (!drag_) cursor_.reset();
  } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
    button->pressed ? press(*button, command) : release(*button, command);
  } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
    turn_wheel(*wheel, command);
  }
  hover(command);
}

void Controls::hover(const Command& command) const {
  AppState& state = command.state;
  state.marks.hovered =
      cursor_ ? pillar_at(command.place, state.look.settings, *cursor_) : std::nullopt;
}

void Controls::press(const ButtonEvent& event, const Command& command) {
  if (drag_ || !contains(command.place.area, event.pixel)) return;
  const bool turns = event.button == MouseButton::left && !event.modifiers.shift &&
                     shows_orbit(command.state.look.settings);
  drag_ = Drag{event.button, turns, event.pixel, event.pixel, false};
}

void Controls::move(Vec2 pixel, const Command& command) {
  cursor_.reset();
  if (contains(command.place.area, pixel)) cursor_ = pixel;
  if (!drag_) return;
  if (!drag_->moved && distance(drag_->begin, pixel) <= shake_of(command)) return;
  drag_->moved = true;
  const Vec2 way{pixel.x - drag_->last.x, pixel.y - drag_->last.y};
  drag_->last = pixel;
  View& view = command.state.look.settings.view;
  if (drag_->turns) {
    orbit(view, way);
  } else {
    pan(view, plot_of(command), way);
  }
  settle(command);
}

void Controls::release(const ButtonEvent& event, const Command& command) {
  if (!drag_ || drag_->button != event.button) return;
  move(event.pixel, command);
  const Drag done = *drag_;
  drag_.reset();
  if (!done.moved && event.button == MouseButton::left) click(event, command);
}

void Controls::click(const ButtonEvent& event, const Command& command) {
  const bool again = last_click_ && event.time_s - last_click_->time_s < kDoubleClickSeconds &&
                     distance(last_click_->pixel, event.pixel) <= shake_of(command);
  // Undoes the first click's change of the pin.
  if (const auto pillar = pillar_at(command.place, command.state.look.settings, event.pixel)) {
    toggle_pin(command.state, *pillar);
  }
  last_click_ = Click{event.time_s, event.pixel};
  if (!again) return;
  reset_view(command.state, command.place);
  last_click_.reset();
}

void Controls::turn_wheel(const WheelEvent& event, const Command& command) {
  if (!contains(command.place.area, event.pixel)) return;
  zoom(command.state.look.settings.view, plot_of(command), in_picture(command, event.pixel),
       std::pow(kZoomOfStep, event.steps));
  settle(command);
  if (event.steps < 0) stop_at_skin(command.state, command.place);
}

}  // namespace pillarfield::viewer
