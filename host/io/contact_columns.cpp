#include "io/contact_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

namespace pillarfield {
namespace {

constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();
template <class Word>
constexpr auto kLastWord = Word{};
template <>
constexpr auto kLastWord<FrictionSource> = FrictionSource::at_least;
template <>
constexpr auto kLastWord<SlipState> = SlipState::sliding;

/// Clamps to the counts that a double holds exactly.
std::uint64_t as_count(double value) {
  constexpr double kMaxExact = 0x1p53;
  return value > 0 ? static_cast<std::uint64_t>(std::min(value, kMaxExact)) : 0;
}

std::optional<std::uint64_t> as_identity(double value) {
  const std::uint64_t id = as_count(value);
  if (id == 0) return std::nullopt;
  return id;
}

std::optional<double> as_number(double value) {
  if (std::isnan(value)) return std::nullopt;
  return value;
}

/// An unknown index becomes the first word, which claims least.
template <class Word>
Word as_word(double value) {
  const std::uint64_t place = as_count(value);
  return static_cast<Word>(place <= static_cast<std::uint64_t>(kLastWord<Word>) ? place : 0);
}

template <class Word>
const char* word_of(double value) {
  return name_of(as_word<Word>(value));
}

/// Sets a component of the wrench, which is unset where a file has no surface.
void set_wrench(ContactQuantities& contact, double value, Vector3 Wrench::*part,
                double Vector3::*axis) {
  if (std::isnan(value)) return;
  if (!contact.wrench) contact.wrench.emplace();
  ((*contact.wrench).*part).*axis = value;
}

SlipForecast& forecast_of(ContactQuantities& contact) {
  if (!contact.slip_forecast) contact.slip_forecast.emplace();
  return *contact.slip_forecast;
}

template <auto member>
double get_forecast(const ContactQuantities& contact) {
  if (!contact.slip_forecast) return kUnset;
  return (*contact.slip_forecast.*member).value_or(kUnset);
}

template <auto member>
void set_forecast(ContactQuantities& contact, double value) {
  if (!std::isnan(value)) forecast_of(contact).*member = value;
}

template <std::size_t within>
double get_probability(const ContactQuantities& contact) {
  return contact.slip_forecast ? contact.slip_forecast->probability[within] : kUnset;
}

template <std::size_t within>
void set_probability(ContactQuantities& contact, double value) {
  if (!std::isnan(value)) forecast_of(contact).probability[within] = value;
}

using Contact = TrackedContact;
using Quantities = ContactQuantities;
using Ended = EndedContact;
using enum ColumnKind;

constexpr std::array<ContactColumn<Contact>, 5> kIdentity = {{
    {"id", "", identity, [](const Contact& c) { return static_cast<double>(c.track_id); },
     [](Contact& c, double v) { c.track_id = as_count(v); }},
    {"parent", "", identity,
     [](const Contact& c) { return static_cast<double>(c.parent.value_or(0)); },
     [](Contact& c, double v) { c.parent = as_identity(v); }},
    {"number", "", count, [](const Contact& c) { return static_cast<double>(c.label); },
     [](Contact& c, double v) { c.label = static_cast<std::uint32_t>(as_count(v)); }},
    {"first_time_s", "s", number, [](const Contact& c) { return c.first_time_s; },
     [](Contact& c, double v) { c.first_time_s = v; }},
    {"age_s", "s", number, [](const Contact& c) { return c.age_s; },
     [](Contact& c, double v) { c.age_s = v; }},
}};

constexpr std::array<ContactColumn<Ended>, 4> kEnded = {{
    {"id", "", identity, [](const Ended& c) { return static_cast<double>(c.track_id); },
     [](Ended& c, double v) { c.track_id = as_count(v); }},
    {"merged_into", "", identity,
     [](const Ended& c) { return static_cast<double>(c.merged_into.value_or(0)); },
     [](Ended& c, double v) { c.merged_into = as_identity(v); }},
    {"first_time_s", "s", number, [](const Ended& c) { return c.first_time_s; },
     [](Ended& c, double v) { c.first_time_s = v; }},
    {"last_time_s", "s", number, [](const Ended& c) { return c.last_time_s; },
     [](Ended& c, double v) { c.last_time_s = v; }},
}};

constexpr std::array<ContactColumn<Quantities>, 35> kQuantities = {{
    {"pillars", "", count, [](const Quantities& q) { return static_cast<double>(q.pillars); },
     [](Quantities& q, double v) { q.pillars = as_count(v); }},
    {"ambiguous", "", count, [](const Quantities& q) { return static_cast<double>(q.ambiguous); },
     [](Quantities& q, double v) { q.ambiguous = as_count(v); }, nullptr, false, true},
    {"resolved", "", count, [](const Quantities& q) { return static_cast<double>(q.resolved); },
     [](Quantities& q, double v) { q.resolved = as_count(v); }, nullptr, false, true},
    {"shear_x_n", "N", number, [](const Quantities& q) { return q.shear_x_n; },
     [](Quantities& q, double v) { q.shear_x_n = v; }, nullptr, false, true},
    {"shear_y_n", "N", number, [](const Quantities& q) { return q.shear_y_n; },
     [](Quantities& q, double v) { q.shear_y_n = v; }, nullptr, false, true},
    {"normal_n", "N", number, [](const Quantities& q) { return q.normal_n; },
     [](Quantities& q, double v) { q.normal_n = v; }},
    {"centre_of_pressure_x_mm", "mm", number,
     [](const Quantities& q) { return q.centre_of_pressure.x_mm; },
     [](Quantities& q, double v) { q.centre_of_pressure.x_mm = v; }},
    {"centre_of_pressure_y_mm", "mm", number,
     [](const Quantities& q) { return q.centre_of_pressure.y_mm; },
     [](Quantities& q, double v) { q.centre_of_pressure.y_mm = v; }},
    {"centre_x_mm", "mm", number, [](const Quantities& q) { return q.centre.x_mm; },
     [](Quantities& q, double v) { q.centre.x_mm = v; }},
    {"centre_y_mm", "mm", number, [](const Quantities& q) { return q.centre.y_mm; },
     [](Quantities& q, double v) { q.centre.y_mm = v; }},
    {"torque_nmm", "N mm", number, [](const Quantities& q) { return q.torque_nmm; },
     [](Quantities& q, double v) { q.torque_nmm = v; }, nullptr, false, true},
    {"area_mm2", "mm^2", number, [](const Quantities& q) { return q.area_mm2; },
     [](Quantities& q, double v) { q.area_mm2 = v; }},
    {"peak_n", "N", number, [](const Quantities& q) { return q.peak_n; },
     [](Quantities& q, double v) { q.peak_n = v; }},
    {"peak_x_mm", "mm", number, [](const Quantities& q) { return q.peak.x_mm; },
     [](Quantities& q, double v) { q.peak.x_mm = v; }},
    {"peak_y_mm", "mm", number, [](const Quantities& q) { return q.peak.y_mm; },
     [](Quantities& q, double v) { q.peak.y_mm = v; }},
    {"mean_pressure_kpa", "kPa", number, [](const Quantities& q) { return q.mean_pressure_kpa; },
     [](Quantities& q, double v) { q.mean_pressure_kpa = v; }},
    {"peak_pressure_kpa", "kPa", number, [](const Quantities& q) { return q.peak_pressure_kpa(); },
     [](Quantities&, double) {}, nullptr, true},
    {"friction", "", number, [](const Quantities& q) { return q.friction.value_or(kUnset); },
     [](Quantities& q, double v) { q.friction = as_number(v); }, nullptr, false, true},
    {"friction_deviation", "", number,
     [](const Quantities& q) { return q.friction_deviation.value_or(kUnset); },
     [](Quantities& q, double v) { q.friction_deviation = as_number(v); }, nullptr, true, true},
    {"friction_source", "", ColumnKind::word,
     [](const Quantities& q) { return static_cast<double>(q.friction_source); },
     [](Quantities& q, double v) { q.friction_source = as_word<FrictionSource>(v); },
     word_of<FrictionSource>, false, true},
    {"slip", "", ColumnKind::word, [](const Quantities& q) { return static_cast<double>(q.slip); },
     [](Quantities& q, double v) { q.slip = as_word<SlipState>(v); }, word_of<SlipState>, false,
     true},
    {"slipping_share", "", number,
     [](const Quantities& q) { return q.slipping_share.value_or(kUnset); },
     [](Quantities& q, double v) { q.slipping_share = as_number(v); }, nullptr, false, true},
    {"slip_margin", "", number, [](const Quantities& q) { return q.slip_margin.value_or(kUnset); },
     [](Quantities& q, double v) { q.slip_margin = as_number(v); }, nullptr, false, true},
    {"time_to_slip_s", "s", number, get_forecast<&SlipForecast::time_s>,
     set_forecast<&SlipForecast::time_s>, nullptr, true, true},
    {"time_to_slip_low_s", "s", number, get_forecast<&SlipForecast::low_s>,
     set_forecast<&SlipForecast::low_s>, nullptr, true, true},
    {"time_to_slip_high_s", "s", number, get_forecast<&SlipForecast::high_s>,
     set_forecast<&SlipForecast::high_s>, nullptr, true, true},
    {"slip_within_0_1_s", "", number, get_probability<0>, set_probability<0>, nullptr, true, true},
    {"slip_within_0_3_s", "", number, get_probability<1>, set_probability<1>, nullptr, true, true},
    {"slip_within_1_s", "", number, get_probability<2>, set_probability<2>, nullptr, true, true},
    {"force_x_n", "N", number,
     [](const Quantities& q) { return q.wrench ? q.wrench->force_n.x : kUnset; },
     [](Quantities& q, double v) { set_wrench(q, v, &Wrench::force_n, &Vector3::x); }, nullptr,
     true},
    {"force_y_n", "N", number,
     [](const Quantities& q) { return q.wrench ? q.wrench->force_n.y : kUnset; },
     [](Quantities& q, double v) { set_wrench(q, v, &Wrench::force_n, &Vector3::y); }, nullptr,
     true},
    {"force_z_n", "N", number,
     [](const Quantities& q) { return q.wrench ? q.wrench->force_n.z : kUnset; },
     [](Quantities& q, double v) { set_wrench(q, v, &Wrench::force_n, &Vector3::z); }, nullptr,
     true},
    {"moment_x_nmm", "N mm", number,
     [](const Quantities& q) { return q.wrench ? q.wrench->moment_nmm.x : kUnset; },
     [](Quantities& q, double v) { set_wrench(q, v, &Wrench::moment_nmm, &Vector3::x); }, nullptr,
     true},
    {"moment_y_nmm", "N mm", number,
     [](const Quantities& q) { return q.wrench ? q.wrench->moment_nmm.y : kUnset; },
     [](Quantities& q, double v) { set_wrench(q, v, &Wrench::moment_nmm, &Vector3::y); }, nullptr,
     true},
    {"moment_z_nmm", "N mm", number,
     [](const Quantities& q) { return q.wrench ? q.wrench->moment_nmm.z : kUnset; },
     [](Quantities& q, double v) { set_wrench(q, v, &Wrench::moment_nmm, &Vector3::z); }, nullptr,
     true},
}};

}  // namespace

std::span<const ContactColumn<TrackedContact>> identity_columns() { return kIdentity; }

QuantityColumns quantity_columns(bool with_wrench, SkinLayout layout) {
  constexpr std::size_t kWrench = 6;
  const auto all = std::span(kQuantities).first(kQuantities.size() - (with_wrench ? 0 : kWrench));
  if (layout == SkinLayout::pillars) return all;
  static const auto of_sensels = [] {
    std::vector<ContactColumn<Quantities>> columns;
    std::ranges::copy_if(kQuantities, std::back_inserter(columns),
                         [](const auto& column) { return !column.of_pillars; });
    columns.front().name = name_of(SkinLayout::sensels);
    return columns;
  }();
  return std::span(of_sensels).first(of_sensels.size() - (with_wrench ? 0 : kWrench));
}

QuantityColumns quantity_columns(const ContactOptions& options) {
  return quantity_columns(options.surface.has_value(), options.layout);
}

std::span<const ContactColumn<EndedContact>> ended_columns() { return kEnded; }

namespace {

template <class Row>
bool is_pressure(const ContactColumn<Row>& column) {
  return column.unit == kPressureUnits.front().name;
}

}  // namespace

template <class Row>
std::string name_of(const ContactColumn<Row>& column, const PressureUnit& unit) {
  std::string name = column.name;
  if (!is_pressure(column)) return name;
  return name.replace(name.rfind('_') + 1, std::string::npos, unit.suffix);
}

template <class Row>
std::string text_of(const ContactColumn<Row>& column, const Row& row, const char* unset,
                    const PressureUnit& unit) {
  const double value = column.get(row) / (is_pressure(column) ? unit.kpa : 1);
  switch (column.kind) {
    case ColumnKind::word:
      return column.word(value);
    case ColumnKind::number:
      return std::isfinite(value) ? fmt::format("{}", value) : unset;
    case ColumnKind::identity:
      if (value == 0) return unset;
      break;
    case ColumnKind::count:
      break;
  }
  return fmt::format("{}", static_cast<std::uint64_t>(value));
}

template <class Row>
std::string words_of(const ContactColumn<Row>& column) {
  const std::string first = column.word(0);  // a place without a word has the first
  std::string words = first;
  for (int place = 1; column.word(place) != first; ++place) {
    words += std::string(", ") + column.word(place);
  }
  return words;
}

template std::string name_of(const ContactColumn<TrackedContact>&, const PressureUnit&);
template std::string text_of(const ContactColumn<TrackedContact>&, const TrackedContact&,
                             const char*, const PressureUnit&);
template std::string name_of(const ContactColumn<ContactQuantities>&, const PressureUnit&);
template std::string text_of(const ContactColumn<ContactQuantities>&, const ContactQuantities&,
                             const char*, const PressureUnit&);
template std::string name_of(const ContactColumn<EndedContact>&, const PressureUnit&);
template std::string text_of(const ContactColumn<EndedContact>&, const EndedContact&, const char*,
                             const PressureUnit&);
template std::string words_of(const ContactColumn<TrackedContact>&);
template std::string words_of(const ContactColumn<ContactQuantities>&);
template std::string words_of(const ContactColumn<EndedContact>&);

}  // namespace pillarfield
