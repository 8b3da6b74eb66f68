#include "io/plain/table_columns.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pillarfield {
namespace {

constexpr std::string_view kDigits = "0123456789";

bool is_whole(std::string_view text) {
  return !text.empty() && text.find_first_not_of(kDigits) == std::string_view::npos;
}

/// Takes parts of a text from its beginning.
class TextTaker {
 public:
  explicit TextTaker(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool at_end() const { return rest_.empty(); }

  /// A number of so many digits, or -1.
  int digits(std::size_t count) {
    const std::string_view text = rest_.substr(0, count);
    if (text.size() != count || !is_whole(text)) return -1;
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

/// What a column holds by its name.
struct ColumnMeaning {
  bool is_index = false;
  bool is_time = false;
  double unit_s = 0;
};

struct TimeUnit {
  std::string_view name;
  double seconds;
};

constexpr std::array kTimeUnits = {
    TimeUnit{"s", 1},     TimeUnit{"sec", 1},        TimeUnit{"seconds", 1}, TimeUnit{"ms", 1e-3},
    TimeUnit{"us", 1e-6}, TimeUnit{"\u00b5s", 1e-6}, TimeUnit{"ns", 1e-9},
};

ColumnMeaning meaning_of(std::string_view name) {
  constexpr std::string_view kBetween = " _-.()[]";
  std::string lower(name);
  std::ranges::transform(lower, lower.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  if (lower == "index" || lower == "frame" || lower == "unnamed: 0") return {.is_index = true};
  const std::string_view text = lower;
  const std::size_t end = std::min(text.find_first_of(kBetween), text.size());
  const std::string_view word = text.substr(0, end);
  if (word != "time" && word != "timestamp" && word != "datetime" && word != "t") return {};
  std::string_view unit = text.substr(end);
  unit.remove_prefix(std::min(unit.find_first_not_of(kBetween), unit.size()));
  unit = unit.substr(0, unit.find_last_not_of(kBetween) + 1);
  if (unit.empty()) return {.is_time = true};
  const TimeUnit* const known = std::ranges::find(kTimeUnits, unit, &TimeUnit::name);
  if (known == kTimeUnits.end()) return {};
  return {.is_time = true, .unit_s = known->seconds};
}

bool is_leading_name(std::string_view name) {
  const ColumnMeaning meaning = meaning_of(name);
  return meaning.is_index || meaning.is_time;
}

/// Whether cells are 0, 1, 2, ..., as pandas names columns.
bool count_columns(std::span<const std::string> cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] != std::to_string(i)) return false;
  }
  return cells.size() > 1;
}

bool has_name(std::span<const std::string> header) {
  return std::ranges::any_of(header, [](const std::string& cell) { return !cell.empty(); });
}

}  // namespace

std::optional<double> parse_iso_time(std::string_view text) {
  TextTaker taker(text);
  const int year = taker.digits(4);
  const bool is_date = taker.one_of("-") != '\0';
  const int month = taker.digits(2);
  const bool is_long = taker.one_of("-") != '\0';
  const int day = taker.digits(2);
  const bool has_clock = taker.one_of("T ") != '\0';
  const int hours = taker.digits(2);
  const bool has_minutes = taker.one_of(":") != '\0';
  const int minutes = taker.digits(2);
  if (year < 0 || month < 0 || day < 0 || !is_date || !is_long || !has_clock || !has_minutes ||
      hours < 0 || hours > 23 || minutes < 0 || minutes > 59) {
    return std::nullopt;
  }
  const int seconds = taker.one_of(":") != '\0' ? taker.digits(2) : 0;
  const auto fraction = taker.one_of(".,") != '\0' ? taker.fraction() : 0.0;
  const auto offset = take_offset(taker);
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (seconds < 0 || seconds > 60 || !fraction || !offset || !taker.at_end() || !date.ok()) {
    return std::nullopt;
  }
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  const std::int64_t whole = ((days * 24 + hours) * 60 + minutes - *offset) * 60 + seconds;
  return static_cast<double>(whole) + *fraction;
}

bool is_header(std::span<const std::string> cells) {
  const bool has_number = std::ranges::any_of(cells, [](const std::string& cell) {
    double value = 0;
    return !cell.empty() && read_cell(cell, value);
  });
  const bool has_time = std::ranges::any_of(
      cells, [](const std::string& cell) { return parse_iso_time(cell).has_value(); });
  if (!has_number && !has_time) return true;
  if (cells.size() < 2) return false;
  if (!cells[0].empty()) return is_leading_name(cells[0]);
  return is_leading_name(cells[1]) || count_columns(cells.subspan(1));
}

LeadingColumns find_leading_columns(std::span<const std::string> header,
                                    std::span<const std::string> first) {
  LeadingColumns found;
  bool has_index = false;
  for (std::size_t i = 0; i < std::min<std::size_t>(first.size(), 2); ++i) {
    const ColumnMeaning meaning = i < header.size() ? meaning_of(header[i]) : ColumnMeaning{};
    const bool is_unnamed = i == 0 && has_name(header) && header[0].empty();
    const bool is_iso = parse_iso_time(first[i]).has_value();
    const bool is_before_iso =
        i == 0 && is_whole(first[0]) && first.size() > 1 && parse_iso_time(first[1]);
    if (!found.time && (is_iso || meaning.is_time || (is_unnamed && !is_whole(first[0])))) {
      found.time = i;
      found.is_iso = is_iso;
      found.unit_s = meaning.unit_s;
    } else if (!has_index && (meaning.is_index || is_unnamed || is_before_iso)) {
      has_index = true;
    } else {
      break;
    }
    ++found.count;
  }
  return found;
}

double likely_unit_s(double time) {
  constexpr double kMostSeconds = 1e11;
  for (const double unit_s : {1.0, 1e-3, 1e-6}) {
    if (!(std::abs(time) * unit_s > kMostSeconds)) return unit_s;
  }
  return 1e-9;
}

bool read_cell(std::string_view cell, double& value) {
  if (cell.empty()) {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  if (cell.starts_with('+')) cell.remove_prefix(1);
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc{} && end == cell.data() + cell.size();
}

}  // namespace pillarfield
