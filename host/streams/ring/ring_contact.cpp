#include "streams/ring/ring_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pillarfield {
namespace {

using Ring = PillarfieldContact;
using Found = ContactQuantities;

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
constexpr double kNever = std::numeric_limits<double>::infinity();

// Members of a ring's contact, and those that they hold.
constexpr std::pair<std::uint64_t Ring::*, std::uint64_t Found::*> kCounts[] = {
    {&Ring::pillars, &Found::pillars},
    {&Ring::ambiguous, &Found::ambiguous},
    {&Ring::resolved, &Found::resolved}};
constexpr std::pair<double Ring::*, double Found::*> kNumbers[] = {
    {&Ring::normal_n, &Found::normal_n},
    {&Ring::area_mm2, &Found::area_mm2},
    {&Ring::peak_n, &Found::peak_n}};
constexpr std::pair<double Ring::*, double Found::*> kOfPillars[] = {
    {&Ring::shear_x_n, &Found::shear_x_n},
    {&Ring::shear_y_n, &Found::shear_y_n},
    {&Ring::torque_nmm, &Found::torque_nmm}};
constexpr std::pair<std::pair<double Ring::*, double Ring::*>, PatchPlace Found::*> kPlaces[] = {
    {{&Ring::centre_x_mm, &Ring::centre_y_mm}, &Found::centre_of_pressure},
    {{&Ring::middle_x_mm, &Ring::middle_y_mm}, &Found::centre},
    {{&Ring::peak_x_mm, &Ring::peak_y_mm}, &Found::peak}};
constexpr std::pair<double Ring::*, std::optional<double> Found::*> kIfKnown[] = {
    {&Ring::friction, &Found::friction},
    {&Ring::friction_deviation, &Found::friction_deviation},
    {&Ring::slip_margin, &Found::slip_margin},
    {&Ring::slipping_share, &Found::slipping_share}};
constexpr std::pair<double Ring::*, std::optional<double> SlipForecast::*> kTimes[] = {
    {&Ring::time_to_slip_s, &SlipForecast::time_s},
    {&Ring::time_to_slip_low_s, &SlipForecast::low_s},
    {&Ring::time_to_slip_high_s, &SlipForecast::high_s}};

static_assert(static_cast<int>(SlipState::sticking) == PILLARFIELD_STICKING &&
              static_cast<int>(SlipState::partial) == PILLARFIELD_PARTIAL_SLIP &&
              static_cast<int>(SlipState::sliding) == PILLARFIELD_SLIDING);
static_assert(static_cast<int>(FrictionSource::given) == PILLARFIELD_FRICTION_GIVEN &&
              static_cast<int>(FrictionSource::observed) == PILLARFIELD_FRICTION_OBSERVED &&
              static_cast<int>(FrictionSource::carried_over) == PILLARFIELD_FRICTION_CARRIED_OVER &&
              static_cast<int>(FrictionSource::at_least) == PILLARFIELD_FRICTION_AT_LEAST);

std::optional<double> if_known(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

template <class State>
State state_from(std::uint32_t value, State last) {
  return value <= static_cast<std::uint32_t>(last) ? static_cast<State>(value) : State{};
}

}  // namespace

PillarfieldContact ring_contact(const ContactQuantities& of) {
  PillarfieldContact to = {};
  for (const auto& [ring, found] : kCounts) to.*ring = of.*found;
  for (const auto& [ring, found] : kNumbers) to.*ring = of.*found;
  for (const auto& [ring, found] : kOfPillars) to.*ring = of.has_shear ? of.*found : kNotKnown;
  for (const auto& [ring, found] : kPlaces) {
    to.*ring.first = (of.*found).x_mm;
    to.*ring.second = (of.*found).y_mm;
  }
  for (const auto& [ring, found] : kIfKnown) to.*ring = (of.*found).value_or(kNotKnown);
  to.slip = static_cast<std::uint32_t>(of.slip);
  to.friction_source = static_cast<std::uint32_t>(of.friction_source);
  const auto& forecast = of.slip_forecast;
  for (const auto& [ring, found] : kTimes) {
    to.*ring = forecast ? (*forecast.*found).value_or(kNever) : kNotKnown;
  }
  std::ranges::fill(to.slip_within, kNotKnown);
  if (forecast) std::ranges::copy(forecast->probability, to.slip_within);
  return to;
}

PillarfieldContact ring_contact(const TrackedContact& tracked) {
  PillarfieldContact contact = ring_contact(tracked.quantities);
  contact.track_id = tracked.track_id;
  contact.label = tracked.label;
  contact.first_time_s = tracked.first_time_s;
  return contact;
}

TrackedContact contact_from(const PillarfieldContact& of, double time_s, SkinLayout layout) {
  TrackedContact tracked;
  tracked.track_id = of.track_id;
  tracked.label = of.label;
  tracked.first_time_s = of.first_time_s;
  tracked.age_s = time_s - of.first_time_s;
  ContactQuantities& to = tracked.quantities;
  to.has_shear = layout == SkinLayout::pillars;
  for (const auto& [ring, found] : kCounts) to.*found = of.*ring;
  for (const auto& [ring, found] : kNumbers) to.*found = of.*ring;
  for (const auto& [ring, found] : kOfPillars) to.*found = to.has_shear ? of.*ring : 0;
  for (const auto& [ring, found] : kPlaces) to.*found = {of.*ring.first, of.*ring.second};
  for (const auto& [ring, found] : kIfKnown) to.*found = if_known(of.*ring);
  to.mean_pressure_kpa = to.area_mm2 > 0 ? 1000 * to.normal_n / to.area_mm2 : 0;
  to.friction_source = state_from(of.friction_source, FrictionSource::at_least);
  to.slip = state_from(of.slip, SlipState::sliding);
  if (!if_known(of.slip_within[0])) return tracked;
  SlipForecast& forecast = to.slip_forecast.emplace();
  for (const auto& [ring, found] : kTimes) forecast.*found = if_known(of.*ring);
  std::ranges::copy(of.slip_within, forecast.probability.begin());
  return tracked;
}

}  // namespace pillarfield
