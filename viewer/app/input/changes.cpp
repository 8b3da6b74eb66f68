#include "viewer/app/input/changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/app/input/pins.h"
#include "viewer/app/panels/region_sums.h"
#include "viewer/app/window/screen.h"

namespace pillarfield::viewer {
namespace {

constexpr std::array kSpeeds{0.01, 0.02, 0.05, 0.1,  0.2,  0.5,  1.0,
                             2.0,  5.0,  10.0, 20.0, 50.0, 100.0};

std::optional<Range>& remembered(Session& session) {
  return session.ranges.at(static_cast<std::size_t>(session.look.quantity));
}

View fitted(const Session& session, const FieldPlace& place, bool orbit) {
  const Viewport plot = layout_of(place.area.width, place.area.height, session.look).plot;
  if (orbit) return fit_orbit(place.skin(), session.look.surface, plot);
  return fit_top(place.skin(), plot);
}

History::Point point_of(const ShownField& field, double shear_x, double shear_y, double normal) {
  return {field.time_s, field.index, static_cast<float>(shear_x), static_cast<float>(shear_y),
          static_cast<float>(normal)};
}

void follow(Pin& pin, const ShownField& field) {
  const PillarValues values = values_at(field, pin.pillar);
  pin.history.add(point_of(field, values.shear_x, values.shear_y, values.normal));
}

void follow_region(Session& session) {
  const RegionSums& sums = region_sums(session);
  session.region->history.add(point_of(*session.field, sums.shear_x, sums.shear_y, sums.normal));
}

}  // namespace

void show_quantity(Session& session, Quantity quantity) {
  Look& look = session.look;
  const QuantityInfo& info = info_of(quantity);
  if (!is_available(quantity, session.player->info())) {
    session.notice = fmt::format("this source has no {}", info.title);
    return;
  }
  const bool same_scale = info_of(look.quantity).scale == info.scale;
  remembered(session) = look.range;
  look.quantity = quantity;
  if (!same_scale) look.map = default_map(info.scale);
  if (const auto& range = remembered(session); range && !session.fit_each_field) {
    look.range = *range;
  } else {
    fit_range(session);
  }
}

void fit_range(Session& session) {
  Look& look = session.look;
  const float most = session.field ? largest(look.quantity, *session.field) : 0;
  look.range = fitting_range(look.quantity, most);
  remembered(session) = look.range;
}

void set_range(Session& session, Range range) {
  const Scale scale = info_of(session.look.quantity).scale;
  const float least = 1e-6f;
  if (scale == Scale::diverging) {
    range.high = std::max(range.high, least);
    range.low = -range.high;
  }
  range.high = std::max(range.high, range.low + least);
  session.look.range = range;
  remembered(session) = range;
}

bool shows_orbit(const Look& look) { return std::holds_alternative<OrbitView>(look.view); }

void show_orbit(Session& session, const FieldPlace& place, bool orbit) {
  if (shows_orbit(session.look) == orbit) return;
  View next = session.other_view.value_or(fitted(session, place, orbit));
  session.other_view = session.look.view;
  if (session.view_is_fitted) {
    next = fitted(session, place, orbit);
    session.other_view.reset();
  }
  session.look.view = next;
}

void show_contacts(Session& session, bool shown) {
  session.look.contacts = shown;
  session.player->set_contacts(shown);
}

void reset_view(Session& session, const FieldPlace& place) {
  session.look.view = fitted(session, place, shows_orbit(session.look));
  session.view_is_fitted = true;
  session.other_view.reset();
}

void set_surface(Session& session, const FieldPlace& place, const Surface& surface) {
  session.look.surface = surface;
  if (session.view_is_fitted) reset_view(session, place);
}

void toggle_pin(Session& session, PillarIndex pillar) {
  auto& pins = session.pins;
  const auto known =
      std::find_if(pins.begin(), pins.end(), [&](const Pin& pin) { return pin.pillar == pillar; });
  if (known != pins.end()) {
    pins.erase(known);
    return;
  }
  if (pins.size() == Session::kMostPins) {
    session.notice = fmt::format("{} pins at most; click one to take it away", Session::kMostPins);
    return;
  }
  pins.push_back({pillar, History()});
  number_pins(session);
  if (session.field) follow(pins.back(), *session.field);
}

void mark_region(Session& session, const PillarRect& rect) {
  session.region = MarkedRegion{rect, History()};
  if (session.field) follow_region(session);
}

void mark_contact(Session& session, const FieldPlace& place, const PatchPlace& centre,
                  const PillarRect& extent) {
  mark_region(session, extent);
  const Vec2 point{centre.x_mm, centre.y_mm};
  const auto pixel = pixel_of(place, session.look, point);
  if (pixel && contains(place.plot(session.look), *pixel)) return;
  if (auto* const top = std::get_if<TopView>(&session.look.view)) {
    top->centre_mm = point;
  } else {
    std::get<OrbitView>(session.look.view).target_mm = point;
  }
  session.view_is_fitted = false;
}

void clear_marks(Session& session) {
  session.pins.clear();
  session.region.reset();
}

void change_speed(Session& session, int steps) {
  const double speed = session.player->state().speed;
  constexpr double kTolerance = 1e-9;
  if (steps > 0) {
    const auto* const faster =
        std::upper_bound(kSpeeds.begin(), kSpeeds.end(), speed * (1 + kTolerance));
    session.player->set_speed(faster == kSpeeds.end() ? kSpeeds.back() : *faster);
  } else {
    const auto* const not_slower =
        std::lower_bound(kSpeeds.begin(), kSpeeds.end(), speed * (1 - kTolerance));
    session.player->set_speed(not_slower == kSpeeds.begin() ? kSpeeds.front() : *(not_slower - 1));
  }
  session.notice = fmt::format("speed {:g}", session.player->state().speed);
}

void take_field(Session& session, ShownField field) {
  session.field = std::move(field);
  for (Pin& pin : session.pins) follow(pin, *session.field);
  if (session.region) follow_region(session);
  if (session.fit_each_field) fit_range(session);
}

}  // namespace pillarfield::viewer
