#include "io/plain/text_cells.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

namespace pillarfield {
namespace {

constexpr std::string_view kDecimalDigits = "0123456789";

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

/// Takes the beginning of a text if it is like `pattern`, whose zeros are any digits, and adds its
/// numbers.
bool take(std::string_view& text, std::string_view pattern, std::vector<int>& numbers) {
  if (text.size() < pattern.size()) return false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const bool is_any = pattern[i] == '0';
    if (is_any ? !is_digit(text[i]) : text[i] != pattern[i]) return false;
    if (is_any && (i == 0 || pattern[i - 1] != '0')) numbers.push_back(0);
    if (is_any) numbers.back() = 10 * numbers.back() + (text[i] - '0');
  }
  text.remove_prefix(pattern.size());
  return true;
}

/// The offset from UTC that a text is, minutes: "Z", "+02:00", "+0200", "+02" or nothing.
std::optional<int> offset_of(std::string_view text) {
  if (text.empty() || text == "Z" || text == "z") return 0;
  const char sign = text.front();
  text.remove_prefix(1);
  std::vector<int> numbers;
  bool is_taken = take(text, "00", numbers);
  if (text.starts_with(':')) text.remove_prefix(1);
  if (is_taken && !text.empty()) is_taken = take(text, "00", numbers);
  numbers.resize(2);
  if ((sign != '+' && sign != '-') || !is_taken || !text.empty() || numbers[0] > 23 ||
      numbers[1] > 59) {
    return std::nullopt;
  }
  return (sign == '-' ? -1 : 1) * (60 * numbers[0] + numbers[1]);
}

/// Takes hours, minutes, seconds and their fraction, s; with `is_whole` the seconds must be there.
std::optional<double> take_clock(std::string_view& text, bool is_whole) {
  std::vector<int> numbers;
  if (!take(text, "00:00", numbers)) return std::nullopt;
  const bool has_seconds = take(text, ":00", numbers);
  if ((is_whole && !has_seconds) || numbers[0] > 23 || numbers[1] > 59 ||
      (has_seconds && numbers[2] > 60)) {
    return std::nullopt;
  }
  const double time_s = (numbers[0] * 60 + numbers[1]) * 60 + (has_seconds ? numbers[2] : 0);
  if (text.empty() || (text[0] != '.' && text[0] != ',')) return time_s;
  const std::size_t end = std::min(text.find_first_not_of(kDecimalDigits, 1), text.size());
  if (end == 1) return std::nullopt;
  double fraction = 0;
  const std::string digits = "0." + std::string(text.substr(1, end - 1));
  std::from_chars(digits.data(), digits.data() + digits.size(), fraction);
  text.remove_prefix(end);
  return time_s + fraction;
}

/// End of the first cell of a line.
std::size_t end_of_cell(std::string_view line, char separator) {
  const std::size_t end = std::min(line.find(separator), line.size());
  if (separator != ' ' || end == line.size()) return end;
  const std::size_t end_of_time = std::min(line.find(separator, end + 1), line.size());
  return parse_time(line.substr(0, end_of_time)) ? end_of_time : end;
}

std::string_view without_quotes(std::string_view cell) {
  const bool is_quoted = cell.size() > 1 && cell.starts_with('"') && cell.ends_with('"');
  return is_quoted ? cell.substr(1, cell.size() - 2) : cell;
}

}  // namespace

std::string_view without_blanks(std::string_view text, std::string_view blanks) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

char separator_of(std::string_view line) {
  for (const char separator : {';', '\t', ','}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

void split_cells(std::string_view line, char separator, std::vector<std::string>& cells) {
  line = without_blanks(line, separator == '\t' ? " \f" : " \t\f");  // Outer cells may be empty.
  for (std::size_t count = 0;; ++count) {
    const std::size_t end = end_of_cell(line, separator);
    if (count == cells.size()) cells.emplace_back();
    cells[count] = without_quotes(without_blanks(line.substr(0, end)));
    if (end == line.size()) return cells.resize(count + 1);
    line.remove_prefix(end + 1);
    if (separator == ' ') line = without_blanks(line);
  }
}

void drop_empty_end(std::vector<std::string>& cells, std::size_t least) {
  while (cells.size() > least && cells.back().empty()) cells.pop_back();
}

bool read_cell(std::string_view cell, char separator, double& value) {
  constexpr std::array<std::string_view, 8> kMissingWords = {"",     "na",   "n/a", "#n/a",
                                                             "null", "none", "-",   "--"};
  if (cell.starts_with('+')) cell.remove_prefix(1);
  std::string with_point;
  if (separator != ',' && cell.find(',') != std::string_view::npos) {
    with_point = cell;
    with_point[cell.find(',')] = '.';
    cell = with_point;
  }
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error == std::errc{} && end == cell.data() + cell.size()) return true;
  value = std::numeric_limits<double>::quiet_NaN();
  return std::ranges::find(kMissingWords, lower_case(cell)) != kMissingWords.end();
}

bool is_value(std::string_view cell, char separator) {
  double value = 0;
  return read_cell(cell, separator, value) || parse_time(cell);
}

std::optional<double> parse_iso_time(std::string_view text) {
  std::vector<int> numbers;
  if (!take(text, "0000-00-00", numbers) || text.empty() || (text[0] != 'T' && text[0] != ' '))
    return std::nullopt;
  text.remove_prefix(1);
  const auto clock_s = take_clock(text, false);
  const auto offset = offset_of(text);
  const std::chrono::year_month_day date{std::chrono::year(numbers[0]),
                                         std::chrono::month(static_cast<unsigned>(numbers[1])),
                                         std::chrono::day(static_cast<unsigned>(numbers[2]))};
  if (!clock_s || !offset || !date.ok()) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return static_cast<double>(days * 86400 - std::int64_t{*offset} * 60) + *clock_s;
}

std::optional<double> parse_time(std::string_view text) {
  if (const auto time_s = parse_iso_time(text)) return time_s;
  const std::string padded = text.find(':') == 1 ? "0" + std::string(text) : std::string(text);
  std::string_view rest = padded;
  const auto clock_s = take_clock(rest, true);
  const std::string half = lower_case(without_blanks(rest));
  if (!clock_s || half.empty()) return clock_s;
  constexpr double kHalfDayS = 43200;
  const bool is_of_half = *clock_s >= 3600 && *clock_s < kHalfDayS + 3600;
  if ((half != "am" && half != "pm") || !is_of_half) return std::nullopt;
  return std::fmod(*clock_s, kHalfDayS) + (half == "pm" ? kHalfDayS : 0);
}

std::optional<double> take_stamp(std::string_view& line) {
  const std::string_view text = without_blanks(line);
  const bool is_in_brackets = text.starts_with('[');
  const std::size_t end = is_in_brackets ? text.find(']') : text.find("->");
  if (end == std::string_view::npos) return std::nullopt;
  const auto time_s = parse_time(without_blanks(text.substr(is_in_brackets, end - is_in_brackets)));
  if (time_s) line = without_blanks(text.substr(end + (is_in_brackets ? 1 : 2)), " ");
  return time_s;
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//") ||
         lower_case(line.substr(0, 4)) == "sep=";
}

bool is_blank_or_rule(std::string_view line) {
  line = without_blanks(line, " \t\f,;");
  constexpr std::string_view kRules = "-=_*~+";
  return line.empty() || (line.size() > 2 && kRules.find(line[0]) != std::string_view::npos &&
                          line.find_first_not_of(line[0]) == std::string_view::npos);
}

double RisingClock::operator()(double time_s) {
  constexpr double kDayS = 86400;
  if (time_s >= 0 && time_s < kDayS && time_s + days_s_ < before_s_ - kDayS / 2) days_s_ += kDayS;
  return before_s_ = time_s + days_s_;
}

std::vector<std::string> words_in(std::string_view name) {
  std::vector<std::string> words;
  bool goes_on = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto letter = static_cast<unsigned char>(name[i]);
    const bool is_letter = std::isalpha(letter) != 0 || letter >= 0x80;
    const bool begins = std::isupper(letter) != 0 && i > 0 &&
                        std::islower(static_cast<unsigned char>(name[i - 1])) != 0;
    if (is_letter && (!goes_on || begins)) words.emplace_back();
    if (is_letter) words.back() += static_cast<char>(std::tolower(letter));
    goes_on = is_letter;
  }
  return words;
}

std::string lower_case(std::string_view text) {
  std::string lower;
  std::ranges::transform(text, std::back_inserter(lower), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return lower;
}

}  // namespace pillarfield
