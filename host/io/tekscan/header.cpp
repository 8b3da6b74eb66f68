#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>

#include "io/tekscan/parser.h"
#include "pillarfield/error.h"
#include "pillarfield/pressure_unit.h"

namespace pillarfield {
namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return lower;
}

[[noreturn]] void refuse(const std::string& place, std::string_view key, std::string_view value,
                         std::string_view mend) {
  throw Error(place, fmt::format("{} is '{:.60}'", key, value), mend);
}

template <class Number>
Number require_number(const std::string& place, std::string_view key, std::string_view value,
                      Number least) {
  const auto number = number_in<Number>(value);
  if (!number || !(*number >= least)) {
    refuse(place, key, value, fmt::format("it must be a number of at least {}", least));
  }
  return *number;
}

/// A unit, lower case, and its size in mm, mm², MPa or N.
struct Unit {
  std::string_view name;
  double size;
};

constexpr Unit kLengths[] = {{"mm", 1},           {"millimeter", 1}, {"millimeters", 1},
                             {"milimeters", 1},   {"cm", 10},        {"centimeter", 10},
                             {"centimeters", 10}, {"in", 25.4},      {"inch", 25.4},
                             {"inches", 25.4},    {"\"", 25.4}};
constexpr Unit kAreas[] = {{"mm2", 1}, {"cm2", 100}, {"m2", 1e6}, {"in2", 645.16}};
constexpr Unit kPressures[] = {
    {"mpa", 1},   {"pa", 1e-6}, {"n/cm2", 1e-2}, {"kg/cm2", 9.80665e-2}, {"g/cm2", 9.80665e-5},
    {"bar", 1e-1}};
constexpr Unit kForces[] = {{"n", 1},
                            {"newton", 1},
                            {"newtons", 1},
                            {"lb", 4.4482216152605},
                            {"lbs", 4.4482216152605},
                            {"kg", 9.80665},
                            {"g", 9.80665e-3}};

/// A unit as it is listed: lower case, without "^", with 2 instead of "²" (UTF-8 or Latin-1).
std::string unit_name(std::string_view text) {
  std::string name;
  for (const char letter : trimmed(text)) {
    if (letter == '\xb2') name += '2';
    if (letter != '^' && letter != '\xb2' && letter != '\xc2') name += letter;
  }
  return lower_case(name);
}

template <std::size_t count>
std::optional<double> size_of_unit(const Unit (&units)[count], std::string_view text) {
  const auto* const known = std::ranges::find(units, unit_name(text), &Unit::name);
  return known == std::end(units) ? std::nullopt : std::optional(known->size);
}

/// A pressure, MPa.
std::optional<double> size_of_pressure(std::string_view text) {
  const auto* const shown =
      std::ranges::find(kPressureUnits, unit_name(text), &PressureUnit::suffix);
  if (shown != kPressureUnits.end()) return shown->kpa * 1e-3;
  return size_of_unit(kPressures, text);
}

/// A number above zero and its unit, as "0.127 centimeters".
template <std::size_t count>
double measure_in(const Unit (&units)[count], const std::string& place, std::string_view key,
                  std::string_view value, std::string_view unit_mend) {
  const std::size_t split = std::min(value.find_first_of(" \t"), value.size());
  const auto unit = size_of_unit(units, value.substr(split));
  if (!unit) refuse(place, key, value, unit_mend);
  const double measure = require_number(place, key, value.substr(0, split), 0.0) * *unit;
  if (!(measure > 0) || !std::isfinite(measure)) refuse(place, key, value, "it must be above zero");
  return measure;
}

double spacing_mm(const std::string& place, std::string_view key, std::string_view value) {
  return measure_in(kLengths, place, key, value,
                    "its unit must be mm, cm or inches, abbreviated or in full");
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  text = trimmed(text);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

template std::optional<double> number_in<double>(std::string_view);
template std::optional<std::uint32_t> number_in<std::uint32_t>(std::string_view);
template std::optional<std::uint64_t> number_in<std::uint64_t>(std::string_view);

void TekscanHeader::parse_line(std::string_view line, const std::string& place) {
  const std::size_t split = std::min(line.find_first_of(" \t"), line.size());
  const std::string_view key = line.substr(0, split);
  const std::string_view value = trimmed(line.substr(split));
  if (key == "ROWS") {
    rows = require_number<std::uint32_t>(place, key, value, 2);
  } else if (key == "COLS") {
    cols = require_number<std::uint32_t>(place, key, value, 2);
  } else if (key == "ROW_SPACING") {
    row_spacing_mm = spacing_mm(place, key, value);
  } else if (key == "COL_SPACING") {
    col_spacing_mm = spacing_mm(place, key, value);
  } else if (key == "NOISE_THRESHOLD") {
    noise_threshold_counts = require_number(place, key, value, 0.0);
  } else if (key == "SECONDS_PER_FRAME") {
    seconds_per_frame = require_number(place, key, value, 0.0);
  } else if (key == "START_FRAME") {
    start_frame = require_number<std::uint64_t>(place, key, value, 0);
  } else if (key == "END_FRAME") {
    end_frame = require_number<std::uint64_t>(place, key, value, 0);
  } else if (key == "UNITS") {
    units_given = true;
    mpa_per_unit = size_of_pressure(value);
    newtons_per_unit = size_of_unit(kForces, value);
    if (lower_case(value) != "raw" && !is_calibrated()) {
      refuse(place, key, value, "it must be raw, kPa, psi, mmHg or N; export it again");
    }
  } else if (key == "SENSEL_AREA") {
    sensel_area_mm2 = measure_in(kAreas, place, key, value, "its unit must be mm2, cm2, m2 or in2");
  }
}

std::optional<double> TekscanHeader::area_mm2() const {
  if (sensel_area_mm2 || (!row_spacing_mm && !col_spacing_mm)) return sensel_area_mm2;
  const double row_mm = row_spacing_mm ? *row_spacing_mm : *col_spacing_mm;
  return row_mm * col_spacing_mm.value_or(row_mm);
}

std::optional<double> TekscanHeader::newtons_per_cell() const {
  if (!mpa_per_unit) return newtons_per_unit;
  const auto area = area_mm2();
  return area ? std::optional(*mpa_per_unit * *area) : std::nullopt;
}

}  // namespace pillarfield
