#include "io/plain/stated_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "io/plain/table_columns.h"
#include "io/plain/text_cells.h"
#include "io/units.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

bool is_unit(std::string_view text) {
  using enum Dimension;
  return lower_case(text) == "hz" ||
         std::ranges::any_of(std::array{length, area, pressure, force, time},
                             [&](Dimension each) { return unit_size(each, text).has_value(); });
}

CellUnit cell_unit(std::string name, int rank) {
  const auto mpa = unit_size(Dimension::pressure, name);
  const auto newtons = unit_size(Dimension::force, name);
  return {std::move(name), mpa, newtons, rank};
}

bool has_word(const std::vector<std::string>& words, std::initializer_list<std::string_view> some) {
  return std::ranges::any_of(
      words, [&](std::string_view word) { return std::ranges::find(some, word) != some.end(); });
}

bool is_digit_at(std::string_view text, std::size_t at) {
  return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0;
}

std::optional<double> number_of(std::string_view token) {
  double value = 0;
  if (!read_cell(token, ' ', value) || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// True for what stands between the numbers of a size, as in "5.08 x 7.62".
bool is_between(std::string_view token) { return token == "x" || token == "*" || token == "/"; }

/// Splits "5.08x7.62mm" and its like into numbers, 'x' and units; other tokens stay.
void add_tokens(std::string_view token, std::vector<std::string>& tokens) {
  const std::size_t before = tokens.size();
  std::string_view rest = token;
  if (is_between(rest.substr(0, 1)) && is_digit_at(rest, 1) && before > 0 &&
      (number_of(tokens.back()) || is_unit(tokens.back()))) {
    tokens.emplace_back(rest.substr(0, 1));
    rest.remove_prefix(1);
  }
  while (!rest.empty() && !parse_time(token)) {
    const std::size_t digits = rest.find_first_not_of("+-.,0123456789");
    const std::size_t end = std::min(digits, rest.size());
    if (!number_of(rest.substr(0, end))) break;
    tokens.emplace_back(rest.substr(0, end));
    rest.remove_prefix(end);
    std::size_t next = 0;  // The next 'x' between numbers.
    while (next < rest.size() && !(is_between(rest.substr(next, 1)) && is_digit_at(rest, next + 1)))
      ++next;
    if (next > 0 && !is_unit(rest.substr(0, next))) break;
    if (next > 0) tokens.emplace_back(rest.substr(0, next));
    rest.remove_prefix(next);
    if (rest.empty()) return;
    tokens.emplace_back(rest.substr(0, 1));
    rest.remove_prefix(1);
  }
  tokens.resize(before);
  tokens.emplace_back(token);
}

/// The tokens of a line: numbers, times, units, words.
std::vector<std::string> tokens_of(std::string_view text, bool has_decimal_commas) {
  std::string line(text);
  for (const std::string_view times : {"\xc3\x97", "\xd7"}) {  // ×
    for (std::size_t at = 0; (at = line.find(times, at)) != std::string::npos;)
      line.replace(at, times.size(), "x");
  }
  std::vector<std::string> tokens;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    const bool is_in_number = is_digit_at(line, i - 1) && is_digit_at(line, i + 1);  // 08:21, 0,86
    const bool ends = i == line.size() ||
                      std::string_view(" \t\f;=()[]\"").find(line[i]) != std::string_view::npos ||
                      (line[i] == ':' && !is_in_number) ||
                      (line[i] == ',' && !(is_in_number && has_decimal_commas));
    if (!ends) continue;
    if (i > begin) add_tokens(std::string_view(line).substr(begin, i - begin), tokens);
    const bool is_inch = i < line.size() && line[i] == '"' && is_digit_at(line, i - 1) &&
                         (begin == 0 || line[begin - 1] != '"');
    if (is_inch) tokens.emplace_back("in");
    begin = i + 1;
  }
  for (std::size_t i = 0; i + 1 < tokens.size(); ++i) {  // "mm Hg", "N / cm2", "N per cm2"
    const bool is_ratio = i + 2 < tokens.size() && (tokens[i + 1] == "/" || tokens[i + 1] == "per");
    const std::string joined =
        is_ratio ? tokens[i] + "/" + tokens[i + 2] : tokens[i] + tokens[i + 1];
    if (!unit_size(Dimension::pressure, joined)) continue;
    tokens[i] = joined;
    tokens.erase(tokens.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                 tokens.begin() + static_cast<std::ptrdiff_t>(i) + (is_ratio ? 3 : 2));
  }
  return tokens;
}

std::vector<std::string> tokens_of(std::string_view line) {
  return tokens_of(line, separator_of(line) != ',');
}

/// The side of a sensel that a word names; NUL if it is none.
char side_of(std::string_view word) {
  for (const char* const width : {"w", "width", "wide", "col", "cols", "column", "columns"})
    if (word == width) return 'w';
  for (const char* const height : {"h", "height", "high", "row", "rows", "length", "long"})
    if (word == height) return 'h';
  return word == "x" || word == "y" ? word[0] : '\0';
}

/// Numbers between words that may be the size of a sensel.
struct SizeGroup {
  struct Number {
    double value = 0;
    std::optional<double> mm;  // of a 1
    char side = '\0';
  };
  std::vector<std::string> words;  // before them
  std::vector<Number> numbers;
  std::optional<double> mm;  // of a 1, by the words

  /// The sides that the words name, in their order.
  [[nodiscard]] std::string sides() const {
    std::string sides;
    for (const std::string& word : words) {
      const char side = side_of(word);
      if (side != '\0' && sides.find(side) == std::string::npos) sides += side;
    }
    const bool is_named = sides.find_first_of("wh") != std::string::npos;
    if (is_named) std::erase_if(sides, [](char side) { return side == 'x' || side == 'y'; });
    return sides;
  }
  [[nodiscard]] bool has_sides_alone() const {
    return std::ranges::all_of(words, [](const std::string& word) {
      return side_of(word) != '\0' || word == "and" || word == "by";
    });
  }
  /// True if the words are about the size of one sensel.
  [[nodiscard]] bool is_of_sensel(bool has_unit) const {
    if (has_word(words, {"thickness", "total", "whole", "overall", "active", "area", "number",
                         "matrix", "array", "mat"}))
      return false;
    return has_word(words, {"spacing"}) || (has_unit && has_word(words, {"pitch", "distance"})) ||
           (has_word(words, {"sensel", "sensels", "cell", "cells", "element", "elements", "taxel",
                             "taxels"}) &&
            (has_unit || has_word(words, {"size", "width", "height", "length", "distance",
                                          "dimension", "dimensions", "pitch"})));
  }
};

/// The groups of numbers in a line.
std::vector<SizeGroup> size_groups(const std::vector<std::string>& tokens) {
  std::vector<SizeGroup> groups(1);
  bool leads = false;  // Sides stand before their numbers.
  bool follows_number = false;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    SizeGroup& group = groups.back();
    const std::string& token = tokens[i];
    const auto value = number_of(token);
    const auto mm = unit_size(Dimension::length, token);
    const std::string lower = lower_case(token);
    const bool is_x = is_between(lower) && i + 1 < tokens.size() && number_of(tokens[i + 1]);
    if (value) {
      if (group.numbers.empty()) leads = group.sides().size() == 1;
      group.numbers.push_back({*value, std::nullopt, '\0'});
    } else if (mm) {
      (group.numbers.empty() ? group.mm : group.numbers.back().mm) = mm;
    } else if (!group.numbers.empty() && (is_x || lower == "by")) {
      continue;
    } else if (side_of(lower) != '\0' && !group.numbers.empty() && !leads && follows_number) {
      group.numbers.back().side = side_of(lower);
    } else {
      if (!group.numbers.empty()) groups.emplace_back();
      std::vector<std::string> words = words_in(token);
      if (lower.size() == 3 && is_between(lower.substr(1, 1)))  // "WxH"
        words = {lower.substr(0, 1), lower.substr(2)};
      std::ranges::move(words, std::back_inserter(groups.back().words));
    }
    follows_number = value || (mm && !groups.back().numbers.empty());
  }
  if (groups.back().numbers.empty() && groups.size() > 1) {  // "..., unit, mm" at the end
    const SizeGroup last = std::move(groups.back());
    groups.pop_back();
    if (last.mm) groups.back().numbers.back().mm = last.mm;
    if (!last.words.empty() && last.has_sides_alone()) groups.back().numbers.push_back({});
  }
  return groups;
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
    const auto value = number_of(token);
    const bool is_number = clock_s || value;
    if (is_number) {
      if (!open.words.empty() && is_unit(open.words.back())) {
        open.unit = open.words.back();
        open.words.pop_back();
      }
      const std::size_t decimals = token.size() - std::min(token.find_first_of(".,"), token.size());
      open.value = clock_s ? *clock_s : *value;
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
  add_size(line);
  for (const Statement& stated : statements) add_number(stated);
}

bool CellUnit::is_same(const CellUnit& other) const {
  return mpa == other.mpa && newtons == other.newtons;
}

void StatedWords::add_unit(CellUnit added) {
  if (added.rank == unit.rank && !added.is_same(unit))
    unclear_unit_ = fmt::format("{} and {}", unit.name, added.name);
  if (added.rank > unit.rank) {
    unit = std::move(added);
    unclear_unit_.clear();
  }
}

void StatedWords::add_unit(std::string_view line) {
  const std::vector<std::string> tokens = tokens_of(line);
  std::vector<std::string> words;
  for (const std::string& token : tokens)
    std::ranges::move(words_in(token), std::back_inserter(words));
  const bool is_sure = has_word(words, {"unit", "units"});
  const bool is_of_cells = has_word(words, {"values", "readings"});
  const bool has_number = std::ranges::any_of(
      tokens, [](const std::string& token) { return number_of(token).has_value(); });
  bool is_known = false;
  for (const std::string& token : tokens) {
    CellUnit named = cell_unit(token, 0);
    is_known = is_known || (token != "in" && is_unit(token));
    if (named.mpa) {
      // Some units are words of other meanings, too.
      const bool is_plain = token == "bar" || token == "Bar" || token == "Pa" || token == "atm";
      const bool is_meant = is_of_cells || has_word(words, {"pressure", "pressures"});
      named.rank = is_sure ? 3 : is_meant ? 2 : has_number || is_plain ? 0 : 1;
    } else if (named.newtons && (is_sure || (is_of_cells && !has_number))) {
      const bool is_of_sums = has_word(words, {"force", "load", "weight", "total"}) && !is_of_cells;
      named.rank = is_of_sums ? 1 : 3;
    } else if (is_sure && has_word({lower_case(token)}, {"raw", "count", "counts", "adc", "lsb",
                                                         "digits", "digit", "bits", "none"})) {
      named = {"counts", std::nullopt, std::nullopt, 3};
      is_known = true;
    }
    if (named.rank > 0) add_unit(std::move(named));
  }
  const std::string lower = lower_case(line);
  const std::size_t end = lower.find_first_not_of("nits", lower.find("unit") + 1);
  const bool is_stated = is_sure && end < line.size() &&
                         std::string_view(":=;,\"\t").find(line[end]) != std::string_view::npos;
  if (is_stated && !is_known && !has_number && tokens.size() > 1 && unit.rank < 3)
    unclear_unit_ = fmt::format("'{:.40}'", without_blanks(line));
}

void StatedWords::add_heading(std::string name) {
  const bool is_marked = name.find_first_of("([") != std::string::npos;
  std::ranges::replace(name, '_', ' ');
  const std::vector<std::string> words = words_in(name);
  for (const std::string& token : tokens_of(name)) {
    CellUnit named = cell_unit(token, 2);
    const bool is_meant =
        is_marked || (named.mpa ? token.size() > 2 || has_word(words, {"pressure", "press"})
                                : has_word(words, {"force", "load"}));
    if (is_meant && (named.mpa || named.newtons)) add_unit(std::move(named));
  }
}

void StatedWords::add_size(std::string_view line) {
  bool has_decimal_commas = separator_of(line) != ',';
  if (!has_decimal_commas) {  // All commas stand between digits.
    has_decimal_commas = true;
    for (std::size_t at = 0; (at = line.find(',', at)) != std::string_view::npos; ++at) {
      has_decimal_commas =
          has_decimal_commas && at > 0 && is_digit_at(line, at - 1) && is_digit_at(line, at + 1);
    }
  }
  const auto refuse = [&] { unclear_size_ = fmt::format("'{:.60}'", without_blanks(line)); };
  std::vector<SizeGroup> groups = size_groups(tokens_of(line, has_decimal_commas));
  std::vector<SizeGroup::Number> numbers;
  bool goes_on = false;
  for (const SizeGroup& group : groups) {
    const bool has_unit = group.mm || std::ranges::any_of(group.numbers, [](const auto& each) {
                            return each.mm.has_value();
                          });
    goes_on = group.is_of_sensel(has_unit) || (goes_on && group.has_sides_alone());
    if (!goes_on) continue;
    const std::string named = group.sides();
    if (named.size() == 1 && group.numbers.size() == 2) return refuse();
    for (std::size_t i = 0; i < group.numbers.size(); ++i) {
      SizeGroup::Number number = group.numbers[i];
      if (!number.mm) number.mm = group.mm;
      if (number.side == '\0' && group.numbers.size() == named.size()) number.side = named[i];
      numbers.push_back(number);
    }
  }
  if (numbers.empty()) return goes_on && has_digit(line) ? refuse() : void();
  std::set<double> units;
  for (const auto& number : numbers) {
    if (number.mm) units.insert(*number.mm);
  }
  std::string sides;
  bool is_clear = numbers.size() <= 2 && !units.empty();
  for (SizeGroup::Number& number : numbers) {
    is_clear = is_clear && number.value > 0 && (number.mm || units.size() == 1);
    if (is_clear) number.value *= number.mm.value_or(*units.begin());
    sides += number.side == 'x' ? 'w' : number.side == 'y' ? 'h' : number.side;
  }
  // "7,5" may be two numbers or one.
  const std::size_t comma = separator_of(line) == ',' && numbers.size() == 1 ? line.find(',') : 0;
  const bool is_one = comma == 0 || !has_decimal_commas || line[comma + 1] == '0' ||
                      (line[comma - 1] == '0' && !is_digit_at(line, comma - 2));
  if (!is_clear || !is_one) return refuse();
  const auto set = [&](std::optional<double>& mm, double value) {
    if (mm && std::abs(*mm / value - 1) > 1e-3) refuse();
    mm = value;
  };
  if (numbers.size() == 2) {
    if (sides[0] == '\0' && sides[1] == '\0') {
      sides = "wh";
      is_order_taken_ = numbers[0].value != numbers[1].value;
    }
    if (sides[0] == '\0') sides[0] = sides[1] == 'w' ? 'h' : 'w';
    if (sides[1] == '\0') sides[1] = sides[0] == 'w' ? 'h' : 'w';
    if (sides[0] == sides[1]) return refuse();
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (sides[i] != 'h') set(width_mm, numbers[i].value);
    if (sides[i] != 'w') set(height_mm, numbers[i].value);
  }
}

void StatedWords::add_number(const Statement& stated) {
  if (!(stated.value > 0) || stated.is_clock) return;
  const bool is_count = stated.unit.empty() && stated.value == std::floor(stated.value);
  const auto mm = unit_size(Dimension::length, stated.unit);
  const auto mm2 = unit_size(Dimension::area, stated.unit);
  const auto seconds = unit_size(Dimension::time, stated.unit);
  if (mm2 && stated.has_only(
                 {"sensel", "sensor", "cell", "element", "taxel", "area", "of", "a", "each"})) {
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
  if (width_mm && height_mm) return Pitch(*height_mm, *width_mm);
  return area_mm2 ? std::optional(Pitch(std::sqrt(*area_mm2))) : std::nullopt;
}

CellUnit unit_of_readings(std::string name) {
  std::erase(name, ' ');
  CellUnit unit = cell_unit(std::move(name), 4);
  if (unit.mpa || unit.newtons || unit.name == "counts") return unit;
  throw Error("--readings", fmt::format("'{:.30}' is no unit of pressure or force", unit.name),
              "give one such as kPa, psi, mmHg, N/cm2 or N, or counts");
}

std::optional<double> StatedWords::newtons_per_cell(std::optional<double> by_forces,
                                                    ReadOptions& options,
                                                    std::vector<std::string>& notes,
                                                    const std::string& place) const {
  const CellUnit cells = options.readings.empty() ? unit : unit_of_readings(options.readings);
  const auto given = options.sensel_pitch_mm;
  if (options.readings.empty() && !unclear_unit_.empty()) {
    throw Error(place, fmt::format("states the unit of its readings as {}", unclear_unit_),
                "say what the numbers are: --readings kPa, N, counts, ... (in Python readings=)");
  }
  const bool is_half = width_mm.has_value() != height_mm.has_value();
  if (!given && (is_half || !unclear_size_.empty())) {
    throw Error(place,
                fmt::format("states {}, which is not understood as the whole size of a sensel",
                            is_half ? "one side of a sensel" : unclear_size_),
                "give it, --pitch-mm MM or ROWSxCOLS");
  }
  const std::optional<Pitch> stated = pitch();
  if (!given) options.sensel_pitch_mm = stated;
  const auto file_mm2 = area_mm2 || !stated ? area_mm2 : std::optional(stated->area_mm2());
  if (cells.name == "counts" && !options.readings.empty()) return std::nullopt;
  if (unit.rank > 0 && !cells.is_same(unit)) {
    notes.push_back(fmt::format("The file states {}, and --readings {} is used instead.", unit.name,
                                cells.name));
  }
  if (given && file_mm2 && std::abs(*file_mm2 / given->area_mm2() - 1) > 0.01) {
    notes.push_back(
        fmt::format("The file states sensels of {:.6g} mm², and --pitch-mm {} is used "
                    "instead.",
                    *file_mm2, text_of(*given)));
  } else if (!given && is_order_taken_) {
    notes.push_back(
        fmt::format("A sensel is taken as {:g} mm wide and {:g} mm high, in the order "
                    "of the file; --pitch-mm ROWSxCOLS gives another.",
                    *width_mm, *height_mm));
  }
  if (!cells.mpa && !cells.newtons && !by_forces) return std::nullopt;
  if (options.counts_per_newton) {
    notes.push_back(
        fmt::format("Readings stay in {}, since counts per newton are given.", cells.name));
    return std::nullopt;
  }
  if (options.falling) throw Error(place, "states pressures or forces", "leave out --falling");
  const auto sensel_mm2 = given ? std::optional(given->area_mm2()) : file_mm2;
  if (cells.mpa && !sensel_mm2 && !by_forces) {
    throw Error(place, fmt::format("states pressures in {} and no area of a sensel", cells.name),
                "give the distance between sensels, --pitch-mm MM");
  }
  const double newtons = cells.newtons             ? *cells.newtons
                         : cells.mpa && sensel_mm2 ? *cells.mpa * *sensel_mm2
                                                   : *by_forces;
  constexpr double kMostRounded = 0.025;  // of an area of "0.86 cm" squared
  if (by_forces && std::abs(*by_forces / newtons - 1) > kMostRounded) {
    const std::string contradiction = fmt::format(
        "states forces of {:.4g} N for a cell of 1 {}, and an area or unit that gives "
        "{:.4g} N",
        *by_forces, cells.name, newtons);
    if (!given && options.readings.empty())
      throw Error(place, contradiction, "its unit or its area is wrong; export it again");
    notes.push_back("The file " + contradiction + ", which is used.");
  }
  options.counts_per_newton = options.layout == SkinLayout::pillars ? 0.25 : 1;
  if (!options.threshold_counts) options.threshold_counts = 0;
  notes.push_back(
      cells.newtons ? fmt::format("Readings are forces on a sensel in {}.", cells.name)
      : cells.mpa && sensel_mm2
          ? fmt::format("Readings are pressures in {}; times {:.6g} mm², {}, they are "
                        "newtons on a sensel.",
                        cells.name, *sensel_mm2,
                        given ? "a sensel by --pitch-mm" : "as the file states")
          : fmt::format("A cell of 1 is {:.6g} N by the forces that the file states.", newtons));
  return newtons;
}

}  // namespace pillarfield
