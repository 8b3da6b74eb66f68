#include "viewer/app/input/actions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/app/input/marks.h"
#include "viewer/app/panels/panels.h"

namespace pillarfield::viewer {
namespace {

constexpr std::array kSpeeds{0.01, 0.02, 0.05, 0.1,  0.2,  0.5,  1.0,
                             2.0,  5.0,  10.0, 20.0, 50.0, 100.0};

std::optional<Range>& remembered(AppState& state) {
  return state.look.ranges.at(static_cast<std::size_t>(state.look.settings.quantity));
}

View fitted(const AppState& state, const FieldPlace& place, bool orbit) {
  const Layout layout = layout_of(place.area.width, place.area.height, state.look.settings);
  if (orbit) return fit_orbit(place.skin(), state.look.settings.surface, layout.plot);
  return fit_top(place.skin(), layout.plot);
}

}  // namespace

void show_quantity(AppState& state, Quantity quantity) {
  RenderSettings& settings = state.look.settings;
  const QuantityInfo info = info_of(quantity);
  if (!is_available(quantity, state.source.player->info())) {
    state.window.notice.fail(fmt::format("this source has no {}", info.title));
    return;
  }
  const bool same_scale = info_of(settings.quantity).scale == info.scale;
  remembered(state) = settings.range;
  settings.quantity = quantity;
  if (!same_scale) settings.map = default_map(info.scale);
  if (const auto& range = remembered(state); range && !state.look.fit_each_field) {
    settings.range = *range;
  } else {
    fit_range(state);
  }
}

void fit_range(AppState& state) {
  RenderSettings& settings = state.look.settings;
  const float most = state.source.field ? largest(settings.quantity, *state.source.field,
                                                  state.source.player->info().skin)
                                        : 0;
  settings.range = fitting_range(settings.quantity, most);
  if (settings.quantity == Quantity::normal) {
    settings.relief_full_n = static_cast<double>(settings.range.high);
  }
  remembered(state) = settings.range;
}

void set_range(AppState& state, Range range) {
  const Scale scale = info_of(state.look.settings.quantity).scale;
  const float least = 1e-6f;
  if (scale == Scale::diverging) {
    range.high = std::max(range.high, least);
    range.low = -range.high;
  }
  range.high = std::max(range.high, range.low + least);
  state.look.settings.range = range;
  remembered(state) = range;
}

bool shows_orbit(const RenderSettings& settings) {
  return std::holds_alternative<OrbitView>(settings.view);
}

void show_orbit(AppState& state, const FieldPlace& place, bool orbit) {
  if (shows_orbit(state.look.settings) == orbit) return;
  View next = state.look.other_view.value_or(fitted(state, place, orbit));
  state.look.other_view = state.look.settings.view;
  if (state.look.view_is_fitted) {
    next = fitted(state, place, orbit);
    state.look.other_view.reset();
  }
  state.look.settings.view = next;
}

void show_contacts(AppState& state, bool shown) {
  state.look.settings.contacts = shown;
  state.source.player->set_contacts(shown);
}

void reset_view(AppState& state, const FieldPlace& place) {
  state.look.settings.view = fitted(state, place, shows_orbit(state.look.settings));
  state.look.view_is_fitted = true;
  state.look.other_view.reset();
}

void stop_at_skin(AppState& state, const FieldPlace& place) {
  const Layout layout = layout_of(place.area.width, place.area.height, state.look.settings);
  if (const auto* const top = std::get_if<TopView>(&state.look.settings.view)) {
    const double least = fit_top(place.skin(), layout.plot).pixels_per_mm;
    if (top->pixels_per_mm <= least) reset_view(state, place);
    return;
  }
  auto& view = std::get<OrbitView>(state.look.settings.view);
  const OrbitView whole = fit_orbit(place.skin(), state.look.settings.surface, layout.plot, view);
  if (view.distance_mm >= whole.distance_mm) view = whole;
}

void toggle_pin(AppState& state, PillarIndex pillar) {
  auto& pins = state.marks.pins;
  const auto known =
      std::find_if(pins.begin(), pins.end(), [&](const Pin& pin) { return pin.pillar == pillar; });
  if (known != pins.end()) {
    pins.erase(known);
    return;
  }
  if (pins.size() == Marks::kMostPins) {
    state.window.notice.fail(
        fmt::format("{} pins at most; click one to take it away", Marks::kMostPins));
    return;
  }
  pins.push_back({pillar});
  number_pins(state.marks);
}

void show_contact(AppState& state, const FieldPlace& place, const PatchPlace& centre) {
  const Vec2 point{centre.x_mm, centre.y_mm};
  const auto pixel = pixel_of(place, state.look.settings, point);
  if (pixel && contains(place.plot(state.look.settings), *pixel)) return;
  if (auto* const top = std::get_if<TopView>(&state.look.settings.view)) {
    top->centre_mm = point;
  } else {
    std::get<OrbitView>(state.look.settings.view).target_mm = point;
  }
  state.look.view_is_fitted = false;
}

void change_speed(AppState& state, int steps) {
  const double speed = state.source.player->state().speed;
  constexpr double kTolerance = 1e-9;
  if (steps > 0) {
    const auto* const faster =
        std::upper_bound(kSpeeds.begin(), kSpeeds.end(), speed * (1 + kTolerance));
    state.source.player->set_speed(faster == kSpeeds.end() ? kSpeeds.back() : *faster);
  } else {
    const auto* const not_slower =
        std::lower_bound(kSpeeds.begin(), kSpeeds.end(), speed * (1 - kTolerance));
    state.source.player->set_speed(not_slower == kSpeeds.begin() ? kSpeeds.front()
                                                                 : *(not_slower - 1));
  }
  state.window.notice = fmt::format("speed {:g}", state.source.player->state().speed);
}

void take_field(AppState& state, ShownField field) {
  state.source.field = std::move(field);
  if (state.look.fit_each_field) fit_range(state);
}

}  // namespace pillarfield::viewer
