#include "pillarfield/contact_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

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

double as_double(const std::optional<std::uint64_t>& id) {
  return static_cast<double>(id.value_or(0));
}
double as_double(const std::optional<double>& value) { return value.value_or(kUnset); }
template <class Value>
double as_double(Value value) {
  return static_cast<double>(value);
}

void put(std::uint64_t& to, double value) { to = as_count(value); }
void put(std::uint32_t& to, double value) { to = static_cast<std::uint32_t>(as_count(value)); }
void put(std::optional<std::uint64_t>& to, double value) { to = as_identity(value); }
void put(double& to, double value) { to = value; }
void put(std::optional<double>& to, double value) { to = as_number(value); }
template <class Word>
requires std::is_enum_v<Word>
void put(Word& to, double value) { to = as_word<Word>(value); }

/// A column without names: kind of its values, and access to them in a row.
template <class Row, class Value>
constexpr ContactColumn<Row> access(double (*get)(const Row&), void (*set)(Row&, double)) {
  ContactColumn<Row> column;
  column.get = get;
  column.set = set;
  if constexpr (std::is_enum_v<Value>) {
    column.kind = ColumnKind::word;
    column.word = word_of<Value>;
  } else if constexpr (std::is_same_v<Value, double> ||
                       std::is_same_v<Value, std::optional<double>>) {
    column.kind = ColumnKind::number;
  }
  return column;
}

template <class Row, class Value>
Row row_of(Value Row::*);

/// Access to a member, or to a member of a member.
template <auto first, auto... path>
constexpr auto member() {
  using Row = decltype(row_of(first));
  using Value = std::remove_cvref_t<decltype(((std::declval<Row&>().*first).*....*path))>;
  return access<Row, Value>([](const Row& row) { return as_double(((row.*first).*....*path)); },
                            [](Row& row, double value) { put(((row.*first).*....*path), value); });
}

/// Access to a member of an optional one. NaN leaves it as it is: a file may lack the whole.
template <auto whole, auto... path>
constexpr ContactColumn<ContactQuantities> member_of_optional() {
  return access<ContactQuantities, double>(
      [](const ContactQuantities& row) {
        return row.*whole ? as_double((*(row.*whole).*....*path)) : kUnset;
      },
      [](ContactQuantities& row, double value) {
        if (std::isnan(value)) return;
        if (!(row.*whole)) (row.*whole).emplace();
        put((*(row.*whole).*....*path), value);
      });
}

/// Probability of slip within SlipForecast::kWithinS[place].
template <std::size_t place>
constexpr ContactColumn<ContactQuantities> probability() {
  return access<ContactQuantities, double>(
      [](const ContactQuantities& row) {
        return row.slip_forecast ? row.slip_forecast->probability[place] : kUnset;
      },
      [](ContactQuantities& row, double value) {
        if (std::isnan(value)) return;
        if (!row.slip_forecast) row.slip_forecast.emplace();
        row.slip_forecast->probability[place] = value;
      });
}

enum Presence { kAlways = 0, kOfPillars = 1, kOptional = 2 };

template <class Row>
constexpr ContactColumn<Row> column(const char* name, const char* unit, const char* help,
                                    ContactColumn<Row> value, int presence = kAlways,
                                    LiveColumn live = {}) {
  value.name = name;
  value.unit = unit;
  value.help = help;
  value.of_pillars = (presence & kOfPillars) != 0;
  value.optional = (presence & kOptional) != 0;
  value.live = live;
  return value;
}

constexpr ContactColumn<ContactQuantities> kPeakPressure = access<ContactQuantities, double>(
    [](const ContactQuantities& row) { return row.peak_pressure_kpa(); },
    [](ContactQuantities&, double) {});

template <class Row>
constexpr ContactColumn<Row> identity(ContactColumn<Row> value) {
  value.kind = ColumnKind::identity;
  return value;
}

using Contact = TrackedContact;
using Ended = EndedContact;
using Q = ContactQuantities;
using F = SlipForecast;
using U = UnseenDeviations;

constexpr ContactColumn<Contact> kIdentity[] = {
    column("id", "", "1, 2, ...; never reused", identity(member<&Contact::track_id>())),
    column("parent", "", "id that it split from", identity(member<&Contact::parent>())),
    column("number", "", "its number in the frame", member<&Contact::label>()),
    column("first_time_s", "s", "time of its first frame", member<&Contact::first_time_s>()),
    column("age_s", "s", "time since then", member<&Contact::age_s>()),
};

constexpr ContactColumn<Ended> kEnded[] = {
    column("id", "", "id of the contact", identity(member<&Ended::track_id>())),
    column("merged_into", "", "id that it merged into", identity(member<&Ended::merged_into>())),
    column("first_time_s", "s", "time of its first frame", member<&Ended::first_time_s>()),
    column("last_time_s", "s", "time of its last frame", member<&Ended::last_time_s>()),
};

// Arguments: name, unit, help, access, presence, and path, head and rank while a sensor runs.
constexpr QuantityColumn kQuantities[] = {
    column("pillars", "", "number of pillars, or of sensels without pillars", member<&Q::pillars>(),
           kAlways, {"pillars"}),
    column("ambiguous", "", "of these, ambiguous by their readings alone", member<&Q::ambiguous>(),
           kOfPillars, {"", "ambiguous", 12}),
    column("resolved", "", "of the ambiguous, resolved by friction", member<&Q::resolved>(),
           kOfPillars),
    column("shear_x_n", "N", "force to the right", member<&Q::shear_x_n>(), kOfPillars,
           {"force.shear_x", "shear x", 5}),
    column("shear_y_n", "N", "force up", member<&Q::shear_y_n>(), kOfPillars,
           {"force.shear_y", "shear y", 6}),
    column("normal_n", "N", "pressing force", member<&Q::normal_n>(), kAlways,
           {"force.normal", "normal", 1}),
    column("centre_of_pressure_x_mm", "mm", "centre of pressure from the centre of the skin",
           member<&Q::centre_of_pressure, &PatchPlace::x_mm>(), kAlways, {"centre_mm.x", "x", 10}),
    column("centre_of_pressure_y_mm", "mm", "centre of pressure from the centre of the skin",
           member<&Q::centre_of_pressure, &PatchPlace::y_mm>(), kAlways, {"centre_mm.y", "y", 11}),
    column("centre_x_mm", "mm", "place of the mean pillar",
           member<&Q::centre, &PatchPlace::x_mm>()),
    column("centre_y_mm", "mm", "place of the mean pillar",
           member<&Q::centre, &PatchPlace::y_mm>()),
    column("torque_nmm", "N mm", "about the outward normal, counter-clockwise",
           member<&Q::torque_nmm>(), kOfPillars, {"torque_nmm", "torque", 9}),
    column("area_mm2", "mm^2", "pillars and unseen ones times the area of one",
           member<&Q::area_mm2>(), kAlways, {"", "area", 15}),
    column("peak_n", "N", "largest normal force of a pillar or sensel", member<&Q::peak_n>(),
           kAlways, {"", "peak", 16}),
    column("peak_x_mm", "mm", "place of the largest normal force",
           member<&Q::peak, &PatchPlace::x_mm>()),
    column("peak_y_mm", "mm", "place of the largest normal force",
           member<&Q::peak, &PatchPlace::y_mm>()),
    column("mean_pressure_kpa", "kPa", "mean pressure", member<&Q::mean_pressure_kpa>(), kAlways,
           {"", "mean", 13}),
    column("peak_pressure_kpa", "kPa", "pressure on the most loaded element", kPeakPressure,
           kOptional, {"peak_pressure_kpa", "max", 14}),
    column("friction", "", "friction coefficient; its lower bound if friction_source is 'at_least'",
           member<&Q::friction>(), kOfPillars, {"friction", "friction", 2}),
    column("friction_deviation", "", "standard deviation of the friction coefficient",
           member<&Q::friction_deviation>(), kOptional | kOfPillars, {"friction_deviation"}),
    column("friction_source", "", "'prior', 'given', 'observed', 'carried_over' or 'at_least'",
           member<&Q::friction_source>(), kOfPillars),
    column("slip", "", "'unknown', 'sticking', 'partial' or 'sliding'", member<&Q::slip>(),
           kOfPillars, {"slip", "slip", 3}),
    column("slipping_share", "", "slipping fraction of the normal force, 0..1",
           member<&Q::slipping_share>(), kOfPillars, {"slipping_share"}),
    column("slip_margin", "", "1 - |shear| / (friction normal), the reserve before it slides",
           member<&Q::slip_margin>(), kOfPillars, {"slip_margin", "slip margin", 8}),
    column("time_to_slip_s", "s", "until it slides as a whole at the present rates",
           member_of_optional<&Q::slip_forecast, &F::time_s>(), kOptional | kOfPillars,
           {"time_to_slip_s", "slips in", 4}),
    column("time_to_slip_low_s", "s", "least time until it slides, of a 95 % interval",
           member_of_optional<&Q::slip_forecast, &F::low_s>(), kOptional | kOfPillars,
           {"time_to_slip_low_s"}),
    column("time_to_slip_high_s", "s", "largest time until it slides, of a 95 % interval",
           member_of_optional<&Q::slip_forecast, &F::high_s>(), kOptional | kOfPillars,
           {"time_to_slip_high_s"}),
    column("slip_within_0_1_s", "", "probability that it slides within 0.1 s", probability<0>(),
           kOptional | kOfPillars, {"slip_within_0_1_s"}),
    column("slip_within_0_3_s", "", "probability that it slides within 0.3 s", probability<1>(),
           kOptional | kOfPillars, {"slip_within_0_3_s", "P(slip) 0.3 s", 7}),
    column("slip_within_1_s", "", "probability that it slides within 1 s", probability<2>(),
           kOptional | kOfPillars, {"slip_within_1_s"}),
    column("unseen", "", "share of its area over missing or masked sensels, 0..1",
           member<&Q::unseen>(), kOptional, {"unseen", "unseen", 17}),
    column("normal_deviation_n", "N", "standard deviation by what is unseen",
           member_of_optional<&Q::unseen_deviations, &U::normal_n>(), kOptional,
           {"unseen_deviation.normal"}),
    column("shear_x_deviation_n", "N", "standard deviation by what is unseen",
           member_of_optional<&Q::unseen_deviations, &U::shear_x_n>(), kOptional | kOfPillars,
           {"unseen_deviation.shear_x"}),
    column("shear_y_deviation_n", "N", "standard deviation by what is unseen",
           member_of_optional<&Q::unseen_deviations, &U::shear_y_n>(), kOptional | kOfPillars,
           {"unseen_deviation.shear_y"}),
    column("centre_of_pressure_x_deviation_mm", "mm", "standard deviation by what is unseen",
           member_of_optional<&Q::unseen_deviations, &U::centre_of_pressure, &PatchPlace::x_mm>(),
           kOptional, {"unseen_deviation.centre_mm.x"}),
    column("centre_of_pressure_y_deviation_mm", "mm", "standard deviation by what is unseen",
           member_of_optional<&Q::unseen_deviations, &U::centre_of_pressure, &PatchPlace::y_mm>(),
           kOptional, {"unseen_deviation.centre_mm.y"}),
    column("torque_deviation_nmm", "N mm", "standard deviation by what is unseen",
           member_of_optional<&Q::unseen_deviations, &U::torque_nmm>(), kOptional | kOfPillars,
           {"unseen_deviation.torque_nmm"}),
    column("force_x_n", "N", "force on the skin in the body's frame",
           member_of_optional<&Q::wrench, &Wrench::force_n, &Vector3::x>(), kOptional),
    column("force_y_n", "N", "force on the skin in the body's frame",
           member_of_optional<&Q::wrench, &Wrench::force_n, &Vector3::y>(), kOptional),
    column("force_z_n", "N", "force on the skin in the body's frame",
           member_of_optional<&Q::wrench, &Wrench::force_n, &Vector3::z>(), kOptional),
    column("moment_x_nmm", "N mm", "moment about the origin of the body's frame",
           member_of_optional<&Q::wrench, &Wrench::moment_nmm, &Vector3::x>(), kOptional),
    column("moment_y_nmm", "N mm", "moment about the origin of the body's frame",
           member_of_optional<&Q::wrench, &Wrench::moment_nmm, &Vector3::y>(), kOptional),
    column("moment_z_nmm", "N mm", "moment about the origin of the body's frame",
           member_of_optional<&Q::wrench, &Wrench::moment_nmm, &Vector3::z>(), kOptional),
};
constexpr std::size_t kWrenchColumns = 6;

std::vector<QuantityColumn> columns_of_sensels() {
  std::vector<QuantityColumn> columns;
  std::ranges::copy_if(kQuantities, std::back_inserter(columns),
                       [](const auto& column) { return !column.of_pillars; });
  columns.front().name = columns.front().live.path = name_of(SkinLayout::sensels);
  return columns;
}

std::vector<QuantityColumn> live_columns_of(SkinLayout layout) {
  std::vector<QuantityColumn> columns;
  std::ranges::copy_if(quantity_columns(false, layout), std::back_inserter(columns),
                       [](const auto& column) { return *column.live.head != '\0'; });
  std::ranges::sort(columns, {}, [](const auto& column) { return column.live.rank; });
  return columns;
}

}  // namespace

std::span<const ContactColumn<TrackedContact>> identity_columns() { return kIdentity; }

QuantityColumns quantity_columns(bool with_wrench, SkinLayout layout) {
  static const std::vector<QuantityColumn> of_sensels = columns_of_sensels();
  const QuantityColumns all =
      layout == SkinLayout::pillars ? kQuantities : QuantityColumns(of_sensels);
  return with_wrench ? all : all.first(all.size() - kWrenchColumns);
}

const QuantityColumn& quantity_column(std::string_view name) {
  const auto* const found = std::ranges::find(kQuantities, name, &QuantityColumn::name);
  if (found == std::end(kQuantities)) throw std::out_of_range(std::string(name));
  return *found;
}

QuantityColumns live_columns(SkinLayout layout) {
  static const auto of_pillars = live_columns_of(SkinLayout::pillars);
  static const auto of_sensels = live_columns_of(SkinLayout::sensels);
  return layout == SkinLayout::pillars ? of_pillars : of_sensels;
}

QuantityColumns quantity_columns(const ContactOptions& options) {
  return quantity_columns(options.surface.has_value(), options.layout);
}

std::span<const ContactColumn<EndedContact>> ended_columns() { return kEnded; }

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
