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
  return state.ranges.at(static_cast<std::size_t>(state.settings.quantity));
}

View fitted(const AppState& state, const FieldPlace& place, bool orbit) {
  const Layout layout = layout_of(place.area.width, place.area.height, state.settings);
  if (orbit) return fitted_orbit(place.skin(), state.settings.surface, layout);
  return fitted_top(place.skin(), layout);
}

}  // namespace

void show_quantity(AppState& state, Quantity quantity) {
  RenderSettings& settings = state.settings;
  const QuantityInfo info = info_of(quantity);
  if (!is_available(quantity, state.player->info())) {
    state.notice = fmt::format("this source has no {}", info.title);
    return;
  }
  const bool same_scale = info_of(settings.quantity).scale == info.scale;
  remembered(state) = settings.range;
  settings.quantity = quantity;
  if (!same_scale) settings.map = default_map(info.scale);
  if (const auto& range = remembered(state); range && !state.fit_each_field) {
    settings.range = *range;
  } else {
    fit_range(state);
  }
}

void fit_range(AppState& state) {
  RenderSettings& settings = state.settings;
  const float most =
      state.field ? largest(settings.quantity, *state.field, state.player->info().skin) : 0;
  settings.range = fitting_range(settings.quantity, most);
  if (settings.quantity == Quantity::normal) {
    settings.relief_full_n = static_cast<double>(settings.range.high);
  }
  remembered(state) = settings.range;
}

void set_range(AppState& state, Range range) {
  const Scale scale = info_of(state.settings.quantity).scale;
  const float least = 1e-6f;
  if (scale == Scale::diverging) {
    range.high = std::max(range.high, least);
    range.low = -range.high;
  }
  range.high = std::max(range.high, range.low + least);
  state.settings.range = range;
  remembered(state) = range;
}

bool shows_orbit(const RenderSettings& settings) {
  return std::holds_alternative<OrbitView>(settings.view);
}

void show_orbit(AppState& state, const FieldPlace& place, bool orbit) {
  if (shows_orbit(state.settings) == orbit) return;
  View next = state.other_view.value_or(fitted(state, place, orbit));
  state.other_view = state.settings.view;
  if (state.view_is_fitted) {
    next = fitted(state, place, orbit);
    state.other_view.reset();
  }
  state.settings.view = next;
}

void show_contacts(AppState& state, bool shown) {
  state.settings.contacts = shown;
  state.player->set_contacts(shown);
  if (state.beside != nullptr) state.beside->set_contacts(shown);
}

void reset_view(AppState& state, const FieldPlace& place) {
  state.settings.view = fitted(state, place, shows_orbit(state.settings));
  state.view_is_fitted = true;
  state.other_view.reset();
}

void stop_at_skin(AppState& state, const FieldPlace& place) {
  const Layout layout = layout_of(place.area.width, place.area.height, state.settings);
  if (const auto* const top = std::get_if<TopView>(&state.settings.view)) {
    const double least = fitted_top(place.skin(), layout).pixels_per_mm;
    if (top->pixels_per_mm <= least) reset_view(state, place);
    return;
  }
  auto& view = std::get<OrbitView>(state.settings.view);
  const OrbitView whole = fitted_orbit(place.skin(), state.settings.surface, layout, view);
  if (view.distance_mm >= whole.distance_mm) view = whole;
}

void set_surface(AppState& state, const FieldPlace& place, const Surface& surface) {
  state.settings.surface = surface;
  if (state.view_is_fitted) reset_view(state, place);
}

void toggle_pin(AppState& state, PillarIndex pillar) {
  auto& pins = state.pins;
  const auto known =
      std::find_if(pins.begin(), pins.end(), [&](const Pin& pin) { return pin.pillar == pillar; });
  if (known != pins.end()) {
    pins.erase(known);
    return;
  }
  if (pins.size() == AppState::kMostPins) {
    state.notice = fmt::format("{} pins at most; click one to take it away", AppState::kMostPins);
    return;
  }
  pins.push_back({pillar});
  number_pins(state);
}

void select_pillars(AppState& state, const PillarRect& rect) { state.selection = Selection{rect}; }

void mark_contact(AppState& state, const FieldPlace& place, const PatchPlace& centre,
                  const PillarRect& extent) {
  select_pillars(state, extent);
  const Vec2 point{centre.x_mm, centre.y_mm};
  const auto pixel = pixel_of(place, state.settings, point);
  if (pixel && contains(place.plot(state.settings), *pixel)) return;
  if (auto* const top = std::get_if<TopView>(&state.settings.view)) {
    top->centre_mm = point;
  } else {
    std::get<OrbitView>(state.settings.view).target_mm = point;
  }
  state.view_is_fitted = false;
}

void clear_marks(AppState& state) {
  state.pins.clear();
  state.selection.reset();
}

void keep_selection(AppState& state) {
  if (!state.selection) {
    state.notice = "select a part first; drag over the field";
    return;
  }
  if (state.boxes.size() == NamedBoxes::kMost) {
    state.notice = fmt::format("{} boxes at most; remove one", NamedBoxes::kMost);
    return;
  }
  int number = 1;
  while (std::ranges::find(state.boxes, number, &NamedBox::number) != state.boxes.end()) ++number;
  state.boxes.push_back({fmt::format("box {}", number), state.selection->rect, number});
  state.selection.reset();
  state.names_box = state.show_panels;
}

void change_speed(AppState& state, int steps) {
  const double speed = state.player->state().speed;
  constexpr double kTolerance = 1e-9;
  if (steps > 0) {
    const auto* const faster =
        std::upper_bound(kSpeeds.begin(), kSpeeds.end(), speed * (1 + kTolerance));
    state.player->set_speed(faster == kSpeeds.end() ? kSpeeds.back() : *faster);
  } else {
    const auto* const not_slower =
        std::lower_bound(kSpeeds.begin(), kSpeeds.end(), speed * (1 - kTolerance));
    state.player->set_speed(not_slower == kSpeeds.begin() ? kSpeeds.front() : *(not_slower - 1));
  }
  state.notice = fmt::format("speed {:g}", state.player->state().speed);
}

void take_field(AppState& state, ShownField field) {
  state.field = std::move(field);
  if (state.fit_each_field) fit_range(state);
}

}  // namespace pillarfield::viewer
