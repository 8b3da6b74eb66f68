#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/plain/text_cells.h"
#include "io/tekscan/parser.h"
#include "io/units.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

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

/// A number above zero and its unit, as "0.127 centimeters".
double measure_in(Dimension dimension, const std::string& place, std::string_view key,
                  std::string_view value, std::string_view unit_mend) {
  const std::size_t split = std::min(value.find_first_of(" \t"), value.size());
  const auto unit = unit_size(dimension, value.substr(split));
  if (!unit) refuse(place, key, value, unit_mend);
  const double measure = require_number(place, key, value.substr(0, split), 0.0) * *unit;
  if (!(measure > 0) || !std::isfinite(measure)) refuse(place, key, value, "it must be above zero");
  return measure;
}

double spacing_mm(const std::string& place, std::string_view key, std::string_view value) {
  return measure_in(Dimension::length, place, key, value,
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
    mpa_per_unit = unit_size(Dimension::pressure, value);
    newtons_per_unit = unit_size(Dimension::force, value);
    if (lower_case(value) != "raw" && !is_calibrated()) {
      refuse(place, key, value, "it must be raw, kPa, psi, mmHg or N; export it again");
    }
  } else if (key == "SENSEL_AREA") {
    sensel_area_mm2 =
        measure_in(Dimension::area, place, key, value, "its unit must be mm2, cm2, m2 or in2");
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
