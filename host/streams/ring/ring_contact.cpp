#include "streams/ring/ring_contact.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace pillarfield {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
constexpr double kNever = std::numeric_limits<double>::infinity();

static_assert(static_cast<int>(SlipState::sticking) == PILLARFIELD_STICKING &&
              static_cast<int>(SlipState::partial) == PILLARFIELD_PARTIAL_SLIP &&
              static_cast<int>(SlipState::sliding) == PILLARFIELD_SLIDING);
static_assert(static_cast<int>(FrictionSource::given) == PILLARFIELD_FRICTION_GIVEN &&
              static_cast<int>(FrictionSource::observed) == PILLARFIELD_FRICTION_OBSERVED &&
              static_cast<int>(FrictionSource::carried_over) == PILLARFIELD_FRICTION_CARRIED_OVER);

std::optional<double> if_known(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

void set_forecast(PillarfieldContact& contact, const std::optional<SlipForecast>& forecast) {
  contact.time_to_slip_s = contact.time_to_slip_low_s = contact.time_to_slip_high_s = kNotKnown;
  std::ranges::fill(contact.slip_within, kNotKnown);
  if (!forecast) return;
  contact.time_to_slip_s = forecast->time_s.value_or(kNever);
  contact.time_to_slip_low_s = forecast->low_s.value_or(kNever);
  contact.time_to_slip_high_s = forecast->high_s.value_or(kNever);
  std::ranges::copy(forecast->probability, contact.slip_within);
}

std::optional<SlipForecast> forecast_from(const PillarfieldContact& contact) {
  if (!std::isfinite(contact.slip_within[0])) return std::nullopt;
  SlipForecast forecast = {.time_s = if_known(contact.time_to_slip_s),
                           .low_s = if_known(contact.time_to_slip_low_s),
                           .high_s = if_known(contact.time_to_slip_high_s)};
  std::ranges::copy(contact.slip_within, forecast.probability.begin());
  return forecast;
}

template <class State>
State state_from(std::uint32_t value, State last) {
  return value <= static_cast<std::uint32_t>(last) ? static_cast<State>(value) : State{};
}

}  // namespace

PillarfieldContact ring_contact(const ContactQuantities& of) {
  const auto of_pillars = [&](double value) { return of.has_shear ? value : kNotKnown; };
  PillarfieldContact contact = {};
  contact.pillars = of.pillars;
  contact.ambiguous = of.ambiguous;
  contact.resolved = of.resolved;
  contact.slip = static_cast<std::uint32_t>(of.slip);
  contact.friction_source = static_cast<std::uint32_t>(of.friction_source);
  contact.shear_x_n = of_pillars(of.shear_x_n);
  contact.shear_y_n = of_pillars(of.shear_y_n);
  contact.normal_n = of.normal_n;
  contact.torque_nmm = of_pillars(of.torque_nmm);
  contact.centre_x_mm = of.centre_of_pressure.x_mm;
  contact.centre_y_mm = of.centre_of_pressure.y_mm;
  contact.middle_x_mm = of.centre.x_mm;
  contact.middle_y_mm = of.centre.y_mm;
  contact.area_mm2 = of.area_mm2;
  contact.peak_n = of.peak_n;
  contact.peak_x_mm = of.peak.x_mm;
  contact.peak_y_mm = of.peak.y_mm;
  contact.friction = of.friction.value_or(kNotKnown);
  contact.friction_deviation = of.friction_deviation.value_or(kNotKnown);
  contact.slip_margin = of.slip_margin.value_or(kNotKnown);
  contact.slipping_share = of.slipping_share.value_or(kNotKnown);
  set_forecast(contact, of.slip_forecast);
  return contact;
}

PillarfieldContact ring_contact(const TrackedContact& tracked) {
  PillarfieldContact contact = ring_contact(tracked.quantities);
  contact.track_id = tracked.track_id;
  contact.label = tracked.label;
  contact.first_time_s = tracked.first_time_s;
  return contact;
}

TrackedContact contact_from(const PillarfieldContact& contact, double time_s, SkinLayout layout) {
  TrackedContact tracked;
  tracked.track_id = contact.track_id;
  tracked.label = contact.label;
  tracked.first_time_s = contact.first_time_s;
  tracked.age_s = time_s - contact.first_time_s;
  ContactQuantities& to = tracked.quantities;
  to.pillars = contact.pillars;
  to.ambiguous = contact.ambiguous;
  to.resolved = contact.resolved;
  to.has_shear = layout == SkinLayout::pillars;
  if (to.has_shear) {
    to.shear_x_n = contact.shear_x_n;
    to.shear_y_n = contact.shear_y_n;
    to.torque_nmm = contact.torque_nmm;
  }
  to.normal_n = contact.normal_n;
  to.centre_of_pressure = {contact.centre_x_mm, contact.centre_y_mm};
  to.centre = {contact.middle_x_mm, contact.middle_y_mm};
  to.area_mm2 = contact.area_mm2;
  to.peak_n = contact.peak_n;
  to.peak = {contact.peak_x_mm, contact.peak_y_mm};
  to.mean_pressure_kpa = to.area_mm2 > 0 ? 1000 * to.normal_n / to.area_mm2 : 0;
  to.friction = if_known(contact.friction);
  to.friction_deviation = if_known(contact.friction_deviation);
  to.friction_source = state_from(contact.friction_source, FrictionSource::carried_over);
  to.slip = state_from(contact.slip, SlipState::sliding);
  to.slip_margin = if_known(contact.slip_margin);
  to.slipping_share = if_known(contact.slipping_share);
  to.slip_forecast = forecast_from(contact);
  return tracked;
}

}  // namespace pillarfield
