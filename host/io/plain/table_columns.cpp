#include "io/plain/table_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "base/nearest_word.h"
#include "io/plain/text_cells.h"
#include "io/units.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::string_view kDigits = "0123456789";

using NameWords = std::set<std::string, std::less<>>;

/// NameWords of names of times.
const NameWords kTimeWords = {"time",  "timestamp", "timestamps", "datetime", "stamp",
                              "epoch", "elapsed",   "clock",      "ts",       "unixtime"};
/// Units that are names of times, too.
const NameWords kTimeUnitWords = {"sec",    "secs", "seconds", "ms", "msec",
                                  "millis", "us",   "micros",  "ns"};
/// Names of columns that are no readings unless a number follows.
const NameWords kNoReadings = {
    "index", "idx",     "id",      "frame",   "sample",   "seq",     "sequence", "counter",
    "count", "packet",  "no",      "nr",      "number",   "label",   "class",    "target",
    "event", "marker",  "trigger", "flag",    "flags",    "status",  "state",    "valid",
    "sum",   "corrupt", "error",   "crc",     "checksum", "total",   "mean",     "average",
    "avg",   "std",     "side",    "subject", "trial",    "session", "phase",    "activity",
    "mode",  "step",    "cycle",   "rssi",    "unnamed",  "date",    "timestep", "resultant"};
/// Names of other measures, with a number or without.
const NameWords kOtherMeasures = {
    "acc",          "accel",     "acceleration", "accelerometer", "gyro",
    "gyr",          "gyroscope", "mag",          "magn",          "angular",
    "magnetometer", "imu",       "quat",         "quaternion",    "roll",
    "pitch",        "yaw",       "temp",         "battery",       "voltage",
    "vbat",         "cop",       "temperature",  "humidity",      "gps"};

bool has_any(const std::vector<std::string>& words, const NameWords& among) {
  return std::ranges::any_of(words, [&](const auto& word) { return among.contains(word); });
}

/// Unit, s, of a column with the name of a time; 0 if the name states none; unset for other names.
std::optional<double> time_unit_of(std::string_view name) {
  const auto words = words_in(name);
  if (words.empty() || has_digit(name) || has_any(words, kNoReadings)) return std::nullopt;
  const bool is_time = has_any(words, kTimeWords) || words[0] == "t" ||
                       (words.size() == 1 && kTimeUnitWords.contains(words[0]));
  if (!is_time) return std::nullopt;
  return unit_size(Dimension::time, words.back()).value_or(0);
}

bool is_no_reading(std::string_view name) {
  const auto words = words_in(name);
  if (has_any(words, kOtherMeasures) || lower_case(name) == "unnamed: 0") return true;
  const std::size_t digit = name.find_last_of(kDigits);
  return has_any(digit == std::string_view::npos ? words : words_in(name.substr(digit)),
                 kNoReadings);
}

bool is_leading_name(std::string_view name) { return names_time(name) || is_no_reading(name); }

bool is_whole(std::string_view text) {
  return !text.empty() && text.find_first_not_of(kDigits) == std::string_view::npos;
}

/// True if cells are 0, 1, 2, ..., as pandas names columns.
bool count_columns(std::span<const std::string> cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] != std::to_string(i)) return false;
  }
  return cells.size() > 1;
}

/// A name with '*' in place of its numbers.
std::string kind_of(std::string_view name) {
  std::string kind;
  for (const char letter : name) {
    const bool is_digit = kDigits.find(letter) != std::string_view::npos;
    if (!is_digit) kind += letter;
    if (is_digit && !kind.ends_with('*')) kind += '*';
  }
  return kind;
}

/// A name with its axis replaced, "p3_y" by "p3_#", and the axis; NUL if it names none.
std::pair<std::string, char> axis_of(std::string name) {
  const auto is_letter = [&](std::size_t at) {
    return at < name.size() && std::isalpha(static_cast<unsigned char>(name[at])) != 0;
  };
  for (std::size_t i = name.size(); i-- > 0;) {
    const auto axis = static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
    const bool is_of_force = i > 0 && (name[i - 1] == 'f' || name[i - 1] == 'F');
    const std::size_t before = is_of_force ? i - 2 : i - 1;  // Wraps to no letter.
    if (axis < 'x' || axis > 'z' || is_letter(i + 1) || is_letter(before)) continue;
    name[i] = '#';
    return {name, axis};
  }
  return {name, '\0'};
}

/// Refuses taxels with three components.
void refuse_components(std::span<const std::string> header, const TableColumns& columns,
                       const std::string& place) {
  std::map<std::string, std::map<char, std::string>> taxels;
  for (const std::size_t column : columns.readings) {
    auto [taxel, axis] = axis_of(header[column]);
    if (axis != '\0') taxels[std::move(taxel)][axis] = header[column];
  }
  std::erase_if(taxels, [](const auto& taxel) { return taxel.second.size() < 3; });
  if (taxels.empty() || 6 * taxels.size() < columns.readings.size()) return;
  const auto& first = taxels.begin()->second;
  throw Error(place,
              fmt::format("has three components for each taxel, '{}', '{}', '{}', which need no "
                          "solver",
                          first.at('x'), first.at('y'), first.at('z')),
              fmt::format("read the normal ones alone with --columns '{}' (in Python columns=)",
                          kind_of(first.at('z'))));
}

/// Refuses names of several kinds in unlike numbers, such as 12 pressures and a setting.
void refuse_kinds(std::span<const std::string> header, const TableColumns& columns,
                  const std::string& place) {
  std::map<std::string, std::size_t> kinds;
  for (const std::size_t column : columns.readings) ++kinds[kind_of(header[column])];
  std::size_t most = 0;
  std::string largest;
  std::vector<std::string> list;
  for (const auto& [kind, count] : kinds) {
    list.push_back(fmt::format("{} ({})", kind, count));
    if (count > most) largest = kind;
    most = std::max(most, count);
  }
  const auto has_most = [&](const auto& kind) { return kind.second == most; };
  if (most < 4 || std::ranges::all_of(kinds, has_most)) return;
  if (list.size() > 12) list = {list.begin(), list.begin() + 12};
  throw Error(
      place, fmt::format("has columns of several kinds: {}", fmt::join(list, ", ")),
      fmt::format("choose the readings, such as --columns '{}' (in Python columns=)", largest));
}

/// Rows of columns whose numbers begin again: 2 x 16 of "R_ch0" to "R_ch15", "L_ch0" to "L_ch15".
std::optional<FrameSize> size_by_numbers(std::span<const std::string> header,
                                         const std::vector<std::size_t>& columns) {
  std::vector<std::string> numbers;
  for (const std::size_t column : columns) {
    std::string_view name = header[column];
    name.remove_suffix(name.size() - 1 - std::min(name.find_last_of(kDigits), name.size() - 1));
    numbers.emplace_back(name.substr(name.find_last_not_of(kDigits) + 1));
  }
  const auto again = std::find(numbers.begin() + 1, numbers.end(), numbers.front());
  const auto cols = static_cast<std::size_t>(again - numbers.begin());
  if (numbers.front().empty() || cols < 2 || numbers.size() % cols != 0) return std::nullopt;
  for (std::size_t i = cols; i < numbers.size(); ++i) {
    if (numbers[i] != numbers[i - cols]) return std::nullopt;
  }
  if (numbers.size() == cols) return std::nullopt;
  return FrameSize{static_cast<std::uint32_t>(numbers.size() / cols),
                   static_cast<std::uint32_t>(cols)};
}

/// True if a name fits a pattern with '*' for any letters and '?' for one.
bool fits_pattern(std::string_view name, std::string_view pattern) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] != '*')
    return !name.empty() && (pattern[0] == '?' || pattern[0] == name[0]) &&
           fits_pattern(name.substr(1), pattern.substr(1));
  for (std::size_t skipped = 0; skipped <= name.size(); ++skipped) {
    if (fits_pattern(name.substr(skipped), pattern.substr(1))) return true;
  }
  return false;
}

/// The columns that a part of ReadOptions::columns names: "3", "1-96", "1-96:2" or a pattern.
std::vector<std::size_t> columns_named(const std::string& part, std::span<const std::string> header,
                                       std::size_t count, const std::string& place) {
  std::vector<std::size_t> chosen;
  if (part.empty() || part.find_first_not_of("0123456789-:") != std::string::npos) {
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (fits_pattern(header[i], part)) chosen.push_back(i);
    }
    if (!chosen.empty()) return chosen;
    if (header.empty()) {
      throw Error(place, fmt::format("no line names columns, so none is '{:.60}'", part),
                  "choose by number, such as --columns 2-25");
    }
    throw Error(place,
                fmt::format("no column is named '{:.60}'{}", part,
                            suggestion(part, {header.begin(), header.end()})),
                "give a name, a pattern such as 'pressure_*', or numbers from 1 on, such as 2-25");
  }
  std::size_t range[3] = {0, 0, 1};  // first, last, step
  const char* at = part.data();
  const char* const end = at + part.size();
  bool is_range = true;
  for (int i = 0; i < 3 && at != end; ++i) {
    const auto read = std::from_chars(at, end, range[i]);
    is_range = is_range && read.ec == std::errc{} && (read.ptr == end || *read.ptr == "-::"[i]);
    at = read.ptr + (read.ptr == end ? 0 : 1);
    if (i == 0 && read.ptr == end) range[1] = range[0];
  }
  if (!is_range || at != end || range[0] < 1 || range[1] < range[0] || range[1] > count ||
      range[2] < 1) {
    throw Error(
        place, fmt::format("has {} columns and none of --columns '{:.60}'", count, part),
        fmt::format("give numbers from 1 to {}, such as 1-{} or 1-{}:2", count, count, count));
  }
  for (std::size_t i = range[0]; i <= range[1]; i += range[2]) chosen.push_back(i - 1);
  return chosen;
}

/// Takes the columns that the options name, in their order; a time stays one.
void take_chosen(TableColumns& columns, std::span<const std::string> header, std::size_t count,
                 const std::string& choice, const std::string& place) {
  columns.readings.clear();
  columns.left_out.clear();
  std::vector<bool> is_known(count);
  for (std::size_t at = 0; at <= choice.size();) {
    const std::size_t end = std::min(choice.find(',', at), choice.size());
    const std::string part(without_blanks(std::string_view(choice).substr(at, end - at)));
    for (const std::size_t column : columns_named(part, header, count, place)) {
      if (!is_known[column] && column != columns.time) columns.readings.push_back(column);
      is_known[column] = true;
    }
    at = end + 1;
  }
}

}  // namespace

bool has_digit(std::string_view name) {
  return name.find_first_of(kDigits) != std::string_view::npos;
}

bool names_time(std::string_view name) { return time_unit_of(name).has_value(); }

bool is_header(std::span<const std::string> cells, char separator) {
  const bool has_number = std::ranges::any_of(cells, [&](const std::string& cell) {
    double value = 0;
    return (!cell.empty() && read_cell(cell, separator, value)) || parse_time(cell);
  });
  if (!has_number) return true;
  if (cells.size() < 2) return false;
  if (!cells[0].empty()) return is_leading_name(cells[0]);
  return is_leading_name(cells[1]) || count_columns(cells.subspan(1));
}

namespace {

/// True if the first column numbers the rows.
bool begins_with_index(std::span<const std::string> header, std::span<const std::string> first) {
  const bool has_times = first.size() > 1 && parse_time(first[1]).has_value();
  return is_whole(first[0]) && (!header.empty() || has_times);
}

/// Sorts the columns by their names and the cells of the first line.
TableColumns sorted_columns(std::span<const std::string> header, std::span<const std::string> first,
                            char separator) {
  TableColumns found;
  std::optional<std::size_t> dated;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::string_view name = i < header.size() ? header[i] : std::string_view();
    const auto unit_s = time_unit_of(name);
    const bool is_time = parse_time(first[i]).has_value();
    double value = 0;
    const bool is_text = !header.empty() && !read_cell(first[i], separator, value);
    const bool is_index = i == 0 && name.empty() && begins_with_index(header, first);
    if (!found.time && unit_s && (is_time || !is_text)) {
      found.time = i;
      found.time_unit_s = is_time ? 1 : *unit_s;
    } else if (is_time) {
      if (!dated) dated = i;
    } else if (unit_s || is_no_reading(name) || is_text || is_index) {
      if (!name.empty()) found.left_out.emplace_back(name);
    } else {
      found.readings.push_back(i);
    }
  }
  if (!found.time && dated) {
    found.time = dated;
    found.time_unit_s = 1;
  }
  return found;
}

}  // namespace

TableColumns choose_columns(std::span<const std::string> header, std::span<const std::string> first,
                            char separator, const ReadOptions& options, const std::string& place) {
  TableColumns found = sorted_columns(header, first, separator);
  if (!options.columns.empty()) take_chosen(found, header, first.size(), options.columns, place);
  if (found.readings.empty()) {
    throw Error(place, "has no column of readings", "choose them with --columns");
  }
  if (header.empty() || long_columns(header, found, place)) return found;
  refuse_components(header, found, place);
  if (found.readings.size() > 1) found.size = size_by_numbers(header, found.readings);
  const auto& size = options.frame_size;
  const bool is_counted = size && found.readings.size() == std::size_t{size->rows} * size->cols;
  if (options.columns.empty() && !is_counted) refuse_kinds(header, found, place);
  return found;
}

std::optional<LongColumns> long_columns(std::span<const std::string> header,
                                        const TableColumns& columns, const std::string& place) {
  const NameWords rows = {"row", "rows", "r", "y", "i"};
  const NameWords cols = {"column", "columns", "col", "cols", "c", "x", "j"};
  const NameWords frames = {"frame", "frames", "sample", "index", "scan", "picture"};
  std::optional<std::size_t> row;
  std::optional<std::size_t> col;
  bool is_named = false;
  LongColumns found;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const auto words = words_in(header[i]);
    if (words.empty() || has_digit(header[i])) continue;
    is_named = is_named || words[0] == "row";
    if (!row && rows.contains(words[0])) row = i;
    if (!col && cols.contains(words[0])) col = i;
    if (!found.frame && frames.contains(words[0])) found.frame = i;
  }
  if (!row || !col) return std::nullopt;
  std::size_t values = 0;
  for (const std::size_t column : columns.readings) {
    if (column == *row || column == *col) continue;
    found.value = column;
    ++values;
  }
  if (!found.frame) found.frame = columns.time;
  found.row = *row;
  found.col = *col;
  if (is_named && values > 1) {
    throw Error(place, fmt::format("has rows, columns and {} readings in each line", values),
                fmt::format("choose one, such as --columns '{}'", header[found.value]));
  }
  return values == 1 ? std::optional(found) : std::nullopt;
}

double likely_unit_s(double time) {
  constexpr double kMostSeconds = 1e11;
  for (const double unit_s : {1.0, 1e-3, 1e-6}) {
    if (!(std::abs(time) * unit_s > kMostSeconds)) return unit_s;
  }
  return 1e-9;
}

}  // namespace pillarfield
