#include "io/plain/text_cells.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <limits>

namespace pillarfield {
namespace {

constexpr std::string_view kDigits = "0123456789";

/// Takes parts of a text from its beginning.
class TextTaker {
 public:
  explicit TextTaker(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool at_end() const { return rest_.empty(); }

  /// A number of so many digits, or -1.
  int digits(std::size_t count) {
    const std::string_view text = rest_.substr(0, count);
    if (text.size() != count || text.find_first_not_of(kDigits) != std::string_view::npos)
      return -1;
    int value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    rest_.remove_prefix(count);
    return value;
  }

  /// One of the letters, or NUL.
  char one_of(std::string_view letters) {
    if (rest_.empty() || letters.find(rest_.front()) == std::string_view::npos) return '\0';
    const char letter = rest_.front();
    rest_.remove_prefix(1);
    return letter;
  }

  /// The digits after a decimal point, which is taken already.
  std::optional<double> fraction() {
    const std::size_t count = std::min(rest_.find_first_not_of(kDigits), rest_.size());
    if (count == 0) return std::nullopt;
    double value = 0;
    const std::string text = "0." + std::string(rest_.substr(0, count));
    std::from_chars(text.data(), text.data() + text.size(), value);
    rest_.remove_prefix(count);
    return value;
  }

 private:
  std::string_view rest_;
};

/// The offset from UTC at the end of a time, minutes: "Z", "+02:00", "+0200", "+02" or nothing.
std::optional<int> take_offset(TextTaker& text) {
  if (text.at_end() || text.one_of("Zz") != '\0') return 0;
  const char sign = text.one_of("+-");
  const int hours = text.digits(2);
  text.one_of(":");
  const int minutes = text.at_end() ? 0 : text.digits(2);
  if (sign == '\0' || hours < 0 || hours > 23 || minutes < 0 || minutes > 59) return std::nullopt;
  return (sign == '-' ? -1 : 1) * (60 * hours + minutes);
}

/// Hours, minutes and seconds, s; with `is_whole` the seconds must be there.
std::optional<double> take_clock(TextTaker& text, bool is_whole) {
  const int hours = text.digits(2);
  const bool has_minutes = text.one_of(":") != '\0';
  const int minutes = text.digits(2);
  const bool has_seconds = text.one_of(":") != '\0';
  const int seconds = has_seconds ? text.digits(2) : 0;
  const auto fraction = text.one_of(".,") != '\0' ? text.fraction() : 0.0;
  if (hours < 0 || hours > 23 || !has_minutes || minutes < 0 || minutes > 59 || seconds < 0 ||
      seconds > 60 || !fraction || (is_whole && !has_seconds)) {
    return std::nullopt;
  }
  return (hours * 60 + minutes) * 60 + seconds + *fraction;
}

/// Where the first cell of a line ends.
std::size_t end_of_cell(std::string_view line, char separator) {
  const std::size_t end = std::min(line.find(separator), line.size());
  if (separator != ' ' || end == line.size()) return end;
  const std::size_t end_of_time = std::min(line.find(separator, end + 1), line.size());
  return parse_iso_time(line.substr(0, end_of_time)) ? end_of_time : end;
}

std::string_view without_quotes(std::string_view cell) {
  const bool is_quoted = cell.size() > 1 && cell.starts_with('"') && cell.ends_with('"');
  return is_quoted ? cell.substr(1, cell.size() - 2) : cell;
}

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

/// Whether blanks separate numbers with decimal commas, "1,5 2,25".
bool has_decimal_commas(std::string_view line) {
  if (without_blanks(line).find(' ') == std::string_view::npos) return false;
  for (std::size_t at = line.find(','); at != std::string_view::npos; at = line.find(',', at + 1)) {
    if (at == 0 || at + 1 == line.size() || !is_digit(line[at - 1]) || !is_digit(line[at + 1]))
      return false;
    const std::size_t end = std::min(line.find_first_not_of(kDigits, at + 1), line.size());
    if (end < line.size() && line[end] != ' ') return false;
  }
  return true;
}

}  // namespace

std::string_view without_blanks(std::string_view text, std::string_view blanks) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

char separator_of(std::string_view line) {
  for (const char separator : {';', '\t', ','}) {
    if (line.find(separator) != std::string_view::npos)
      return separator == ',' && has_decimal_commas(line) ? ' ' : separator;
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
  constexpr std::array<std::string_view, 8> kMissing = {"",     "na",   "n/a", "#n/a",
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
  return std::ranges::find(kMissing, lower_case(cell)) != kMissing.end();
}

std::optional<double> parse_iso_time(std::string_view text) {
  TextTaker taker(text);
  const int year = taker.digits(4);
  const bool is_date = taker.one_of("-") != '\0';
  const int month = taker.digits(2);
  const bool is_long = taker.one_of("-") != '\0';
  const int day = taker.digits(2);
  if (year < 0 || month < 0 || day < 0 || !is_date || !is_long || taker.one_of("T ") == '\0')
    return std::nullopt;
  const auto clock_s = take_clock(taker, false);
  const auto offset = take_offset(taker);
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!clock_s || !offset || !taker.at_end() || !date.ok()) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return static_cast<double>(days * 86400 - *offset * 60) + *clock_s;
}

std::optional<double> parse_time(std::string_view text) {
  if (const auto time_s = parse_iso_time(text)) return time_s;
  const std::string padded = text.find(':') == 1 ? "0" + std::string(text) : std::string(text);
  TextTaker taker(padded);
  const auto clock_s = take_clock(taker, true);
  return taker.at_end() ? clock_s : std::nullopt;
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
