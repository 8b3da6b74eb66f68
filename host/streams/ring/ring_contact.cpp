#include "streams/ring/ring_contact.h"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

#include "pillarfield/contact_columns.h"

namespace pillarfield {
namespace {

using Ring = PillarfieldContact;

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
constexpr double kNever = std::numeric_limits<double>::infinity();

/// A quantity in a ring's contact: a count as uint64, a word as uint32, a number as double.
struct RingColumn {
  const QuantityColumn& column;
  std::size_t offset;
};

/// All quantities but mean and peak pressure, which follow from others, and the wrench.
const std::vector<RingColumn>& ring_columns() {
  static const std::vector<RingColumn> columns = {
      {quantity_column("pillars"), offsetof(Ring, pillars)},
      {quantity_column("ambiguous"), offsetof(Ring, ambiguous)},
      {quantity_column("resolved"), offsetof(Ring, resolved)},
      {quantity_column("shear_x_n"), offsetof(Ring, shear_x_n)},
      {quantity_column("shear_y_n"), offsetof(Ring, shear_y_n)},
      {quantity_column("normal_n"), offsetof(Ring, normal_n)},
      {quantity_column("centre_of_pressure_x_mm"), offsetof(Ring, centre_x_mm)},
      {quantity_column("centre_of_pressure_y_mm"), offsetof(Ring, centre_y_mm)},
      {quantity_column("centre_x_mm"), offsetof(Ring, middle_x_mm)},
      {quantity_column("centre_y_mm"), offsetof(Ring, middle_y_mm)},
      {quantity_column("torque_nmm"), offsetof(Ring, torque_nmm)},
      {quantity_column("area_mm2"), offsetof(Ring, area_mm2)},
      {quantity_column("peak_n"), offsetof(Ring, peak_n)},
      {quantity_column("peak_x_mm"), offsetof(Ring, peak_x_mm)},
      {quantity_column("peak_y_mm"), offsetof(Ring, peak_y_mm)},
      {quantity_column("friction"), offsetof(Ring, friction)},
      {quantity_column("friction_deviation"), offsetof(Ring, friction_deviation)},
      {quantity_column("friction_source"), offsetof(Ring, friction_source)},
      {quantity_column("slip"), offsetof(Ring, slip)},
      {quantity_column("slipping_share"), offsetof(Ring, slipping_share)},
      {quantity_column("slip_margin"), offsetof(Ring, slip_margin)},
      {quantity_column("time_to_slip_s"), offsetof(Ring, time_to_slip_s)},
      {quantity_column("time_to_slip_low_s"), offsetof(Ring, time_to_slip_low_s)},
      {quantity_column("time_to_slip_high_s"), offsetof(Ring, time_to_slip_high_s)},
      {quantity_column("slip_within_0_1_s"), offsetof(Ring, slip_within[0])},
      {quantity_column("slip_within_0_3_s"), offsetof(Ring, slip_within[1])},
      {quantity_column("slip_within_1_s"), offsetof(Ring, slip_within[2])},
      {quantity_column("unseen"), offsetof(Ring, unseen)},
      {quantity_column("normal_deviation_n"), offsetof(Ring, normal_deviation_n)},
      {quantity_column("shear_x_deviation_n"), offsetof(Ring, shear_x_deviation_n)},
      {quantity_column("shear_y_deviation_n"), offsetof(Ring, shear_y_deviation_n)},
      {quantity_column("centre_of_pressure_x_deviation_mm"), offsetof(Ring, centre_x_deviation_mm)},
      {quantity_column("centre_of_pressure_y_deviation_mm"), offsetof(Ring, centre_y_deviation_mm)},
      {quantity_column("torque_deviation_nmm"), offsetof(Ring, torque_deviation_nmm)}};
  return columns;
}

template <class Value>
void put_at(std::byte* place, double value) {
  const auto stored = static_cast<Value>(value);
  std::memcpy(place, &stored, sizeof stored);
}
template <class Value>
double get_at(const std::byte* place) {
  Value stored;
  std::memcpy(&stored, place, sizeof stored);
  return static_cast<double>(stored);
}

void put(Ring& to, const RingColumn& at, double value) {
  std::byte* const place = reinterpret_cast<std::byte*>(&to) + at.offset;
  if (at.column.kind == ColumnKind::number) return put_at<double>(place, value);
  if (at.column.kind == ColumnKind::word) return put_at<std::uint32_t>(place, value);
  put_at<std::uint64_t>(place, value);
}

/// NaN for a number that is not known.
double get(const Ring& from, const RingColumn& at) {
  const std::byte* const place = reinterpret_cast<const std::byte*>(&from) + at.offset;
  if (at.column.kind == ColumnKind::word) return get_at<std::uint32_t>(place);
  if (at.column.kind != ColumnKind::number) return get_at<std::uint64_t>(place);
  const double value = get_at<double>(place);
  return std::isfinite(value) ? value : kNotKnown;
}

static_assert(static_cast<int>(SlipState::sticking) == PILLARFIELD_STICKING &&
              static_cast<int>(SlipState::partial) == PILLARFIELD_PARTIAL_SLIP &&
              static_cast<int>(SlipState::sliding) == PILLARFIELD_SLIDING);
static_assert(static_cast<int>(FrictionSource::given) == PILLARFIELD_FRICTION_GIVEN &&
              static_cast<int>(FrictionSource::observed) == PILLARFIELD_FRICTION_OBSERVED &&
              static_cast<int>(FrictionSource::carried_over) == PILLARFIELD_FRICTION_CARRIED_OVER &&
              static_cast<int>(FrictionSource::at_least) == PILLARFIELD_FRICTION_AT_LEAST);

}  // namespace

PillarfieldContact ring_contact(const ContactQuantities& of) {
  PillarfieldContact to = {};
  for (const RingColumn& each : ring_columns()) {
    const bool exists = of.has_shear || !each.column.of_pillars;
    const bool is_number = each.column.kind == ColumnKind::number;
    put(to, each, exists || !is_number ? each.column.get(of) : kNotKnown);
  }
  if (!of.slip_forecast) return to;
  for (double* const time : {&to.time_to_slip_s, &to.time_to_slip_low_s, &to.time_to_slip_high_s}) {
    if (std::isnan(*time)) *time = kNever;
  }
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
  for (const RingColumn& each : ring_columns()) {
    if (to.has_shear || !each.column.of_pillars) each.column.set(to, get(of, each));
  }
  to.mean_pressure_kpa = to.area_mm2 > 0 ? 1000 * to.normal_n / to.area_mm2 : 0;
  return tracked;
}

}  // namespace pillarfield
