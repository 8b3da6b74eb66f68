#include "io/tekscan/header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "pillarfield/error.h"

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

double spacing_mm(const std::string& place, std::string_view key, std::string_view value) {
  static constexpr std::array<std::pair<std::string_view, double>, 11> kMillimetres = {{
      {"mm", 1.0},
      {"millimeter", 1.0},
      {"millimeters", 1.0},
      {"milimeters", 1.0},
      {"cm", 10.0},
      {"centimeter", 10.0},
      {"centimeters", 10.0},
      {"in", 25.4},
      {"inch", 25.4},
      {"inches", 25.4},
      {"\"", 25.4},
  }};
  const std::size_t split = std::min(value.find_first_of(" \t"), value.size());
  const std::string unit = lower_case(trimmed(value.substr(split)));
  const auto* const known = std::find_if(kMillimetres.begin(), kMillimetres.end(),
                                         [&](const auto& entry) { return entry.first == unit; });
  if (known == kMillimetres.end()) {
    refuse(place, key, value, "its unit must be mm, cm or inches, abbreviated or in full");
  }
  const double spacing = require_number(place, key, value.substr(0, split), 0.0) * known->second;
  if (!(spacing > 0) || !std::isfinite(spacing)) refuse(place, key, value, "it must be above zero");
  return spacing;
}

void require_raw(const std::string& place, std::string_view value) {
  if (lower_case(value) == "raw") return;
  refuse(place, "UNITS", value, "export it again in raw units: forces are solved from counts");
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
    require_raw(place, value);
    units_given = true;
  }
}

}  // namespace pillarfield
