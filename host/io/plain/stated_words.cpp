#include "io/plain/stated_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <utility>

#include "io/plain/text_cells.h"
#include "io/units.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

bool is_unit(std::string_view text) {
  return unit_size(Dimension::length, text) || unit_size(Dimension::area, text) ||
         unit_size(Dimension::pressure, text) || unit_size(Dimension::force, text) ||
         unit_size(Dimension::time, text) || lower_case(text) == "hz";
}

bool has_word(const std::vector<std::string>& words, std::initializer_list<std::string_view> some) {
  return std::ranges::any_of(
      words, [&](std::string_view word) { return std::ranges::find(some, word) != some.end(); });
}

/// The tokens of a line: numbers, times, units, words.
std::vector<std::string> tokens_of(std::string_view line) {
  const bool has_decimal_commas = separator_of(line) != ',';
  const auto is_digit = [&](std::size_t at) {
    return at < line.size() && std::isdigit(static_cast<unsigned char>(line[at])) != 0;
  };
  std::vector<std::string> tokens;
  bool goes_on = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool is_in_number = is_digit(i - 1) && is_digit(i + 1);  // 08:21:17, 0,86
    const bool is_between =
        std::string_view(" \t\f;=()[]\"").find(line[i]) != std::string_view::npos ||
        (line[i] == ':' && !is_in_number) ||
        (line[i] == ',' && !(is_in_number && has_decimal_commas));
    if (!is_between && !goes_on) tokens.emplace_back();
    if (!is_between) tokens.back() += line[i];
    goes_on = !is_between;
  }
  return tokens;
}

}  // namespace

bool Statement::has_any(std::initializer_list<std::string_view> some) const {
  return has_word(words, some);
}

bool Statement::has_only(std::initializer_list<std::string_view> some) const {
  return !words.empty() && std::ranges::all_of(words, [&](std::string_view word) {
    return std::ranges::find(some, word) != some.end();
  });
}

std::vector<Statement> statements_in(std::string_view line, std::uint64_t number) {
  std::vector<Statement> done;
  Statement open;
  bool follows_number = false;
  for (const std::string& token : tokens_of(line)) {
    const auto clock_s = parse_time(token);
    double value = 0;
    const bool is_number = clock_s || (read_cell(token, ' ', value) && std::isfinite(value));
    if (is_number) {
      if (!open.words.empty() && is_unit(open.words.back())) {
        open.unit = open.words.back();
        open.words.pop_back();
      }
      const std::size_t decimals = token.size() - std::min(token.find_first_of(".,"), token.size());
      open.value = clock_s.value_or(value);
      open.is_clock = clock_s.has_value();
      open.rounding = 0.5 * std::pow(10.0, decimals > 1 ? 1 - static_cast<double>(decimals) : 0);
      open.line = number;
      done.push_back(std::exchange(open, {}));
    } else if (is_unit(token)) {
      if (follows_number && done.back().unit.empty()) {
        done.back().unit = token;
      } else {
        open.words.push_back(token);
      }
    } else {
      for (std::string& word : words_in(token)) open.words.push_back(std::move(word));
    }
    follows_number = is_number;
  }
  return done;
}

void StatedWords::add(std::string_view line, const std::vector<Statement>& statements) {
  add_unit(line);
  for (const Statement& stated : statements) add_number(stated);
}

void StatedWords::add_unit(std::string_view line) {
  const std::vector<std::string> tokens = tokens_of(line);
  std::vector<std::string> words;
  for (const std::string& token : tokens)
    std::ranges::move(words_in(token), std::back_inserter(words));
  const bool is_sure = has_word(words, {"unit", "units"});
  for (const std::string& token : tokens) {
    const auto size = unit_size(Dimension::pressure, token);
    if (!size || is_unit_sure || (mpa && !is_sure)) continue;
    if (!is_sure && !has_word(words, {"pressure", "pressures", "values", "readings"})) continue;
    mpa = size;
    unit = token;
    is_unit_sure = is_sure;
  }
}

void StatedWords::add_number(const Statement& stated) {
  if (!(stated.value > 0) || stated.is_clock) return;
  const bool is_count = stated.unit.empty() && stated.value == std::floor(stated.value);
  const auto mm = unit_size(Dimension::length, stated.unit);
  const auto mm2 = unit_size(Dimension::area, stated.unit);
  const auto seconds = unit_size(Dimension::time, stated.unit);
  if (mm && stated.has_any({"sensel", "cell", "element", "spacing", "pitch", "distance"})) {
    const bool is_height = stated.has_any({"height", "row", "rows"});
    (is_height ? height_mm : width_mm) = stated.value * *mm;
  } else if (mm2 && stated.has_only({"sensel", "sensor", "cell", "element", "area"})) {
    area_mm2 = stated.value * *mm2;
  } else if (stated.has_any({"rate", "frequency", "fps"}) && !mm && !seconds) {
    period_s = 1 / stated.value;
  } else if (seconds && stated.has_any({"per", "picture", "interval", "period"})) {
    period_s = stated.value * *seconds;
  } else if (is_count && stated.has_only({"row", "rows", "number", "of"})) {
    rows = stated.value;
  } else if (is_count && stated.has_only({"column", "columns", "cols", "number", "of"})) {
    cols = stated.value;
  }
}

std::optional<Pitch> StatedWords::pitch() const {
  if (width_mm || height_mm)
    return Pitch(height_mm ? *height_mm : *width_mm, width_mm ? *width_mm : *height_mm);
  return area_mm2 ? std::optional(Pitch(std::sqrt(*area_mm2))) : std::nullopt;
}

std::optional<double> StatedWords::newtons_per_cell(std::optional<double> by_forces,
                                                    ReadOptions& options,
                                                    std::vector<std::string>& notes,
                                                    const std::string& place) const {
  const std::optional<Pitch> stated = pitch();
  if (!options.sensel_pitch_mm) options.sensel_pitch_mm = stated;
  auto sensel_mm2 = area_mm2;
  if (!sensel_mm2 && stated) sensel_mm2 = stated->area_mm2();
  const bool is_stated = sensel_mm2.has_value();
  if (!is_stated && options.sensel_pitch_mm) sensel_mm2 = options.sensel_pitch_mm->area_mm2();
  if (!mpa && !by_forces) return std::nullopt;
  if (options.counts_per_newton) {
    notes.push_back(fmt::format("Readings stay in {}, since counts per newton are given.", unit));
    return std::nullopt;
  }
  if (options.falling) throw Error(place, "states pressures or forces", "leave out --falling");
  if (!sensel_mm2 && !by_forces) {
    throw Error(place, fmt::format("states pressures in {} and no area of a sensel", unit),
                "give the distance between sensels, --pitch-mm MM");
  }
  const double newtons = mpa && sensel_mm2 ? *mpa * *sensel_mm2 : *by_forces;
  constexpr double kMostRounded = 0.025;  // of an area of "0.86 cm" squared
  if (by_forces && is_stated && std::abs(*by_forces / newtons - 1) > kMostRounded) {
    throw Error(place,
                fmt::format("states forces of {:.4g} N for a cell of 1 {}, and an area that gives "
                            "{:.4g} N",
                            *by_forces, unit, newtons),
                "its unit or its area is wrong; export it again");
  }
  options.counts_per_newton = options.layout == SkinLayout::pillars ? 0.25 : 1;
  if (!options.threshold_counts) options.threshold_counts = 0;
  notes.push_back(
      mpa && sensel_mm2
          ? fmt::format("Readings are pressures in {}; times {:.6g} mm², {}, they are "
                        "newtons on a sensel.",
                        unit, *sensel_mm2,
                        is_stated ? "as the file states" : "the square of the pitch")
          : fmt::format("A cell of 1 is {:.6g} N by the forces that the file states.", newtons));
  return newtons;
}

}  // namespace pillarfield
