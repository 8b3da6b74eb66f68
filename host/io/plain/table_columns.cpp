#include "io/plain/table_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "base/nearest_word.h"
#include "io/plain/column_names.h"
#include "io/plain/text_cells.h"
#include "io/proposal.h"
#include "io/units.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::string_view kDigits = "0123456789";

using NameWords = std::set<std::string, std::less<>>;

/// NameWords of names of times.
const NameWords kTimeWords = {"time",  "timestamp", "timestamps", "datetime", "stamp",
                              "epoch", "elapsed",   "clock",      "ts",       "unixtime"};
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
  const auto unit_s = unit_size(Dimension::time, words.back());
  const bool is_time = has_any(words, kTimeWords) || words[0] == "t" ||
                       (words.size() == 1 && words[0].size() > 1 && unit_s);
  return is_time ? std::optional(unit_s.value_or(0)) : std::nullopt;
}

bool is_no_reading(std::string_view name) {
  const auto words = words_in(name);
  if (has_any(words, kOtherMeasures) || lower_case(name) == "unnamed: 0") return true;
  const std::size_t digit = name.find_last_of(kDigits);
  return has_any(digit == std::string_view::npos ? words : words_in(name.substr(digit)),
                 kNoReadings);
}

bool is_whole(std::string_view text) {
  return !text.empty() && text.find_first_not_of(kDigits) == std::string_view::npos;
}

/// Ways on that take one kind of columns each.
Proposal proposal_of(std::span<const std::string> header, const ColumnFamily& kind,
                     const ReadOptions& options) {
  const std::string choice = choice_of(header, kind);
  ReadOptions chosen = options;
  chosen.columns = choice;
  const bool is_open = !stated_size(kinds_of(header, kind.columns));
  return {fmt::format("--columns '{}'", choice), chosen, is_open ? kind.columns.size() : 0};
}

std::string list_of(const std::vector<ColumnFamily>& kinds) {
  constexpr std::size_t kMostListed = 12;
  std::vector<std::string> list;
  for (const ColumnFamily& kind : kinds) {
    list.push_back(fmt::format("{} ({})", kind.pattern, kind.columns.size()));
  }
  if (list.size() > kMostListed) list.resize(kMostListed);
  return fmt::format("{}", fmt::join(list, ", "));
}

/// The kind of readings: the most columns, and the only ones with the name of readings; null if
/// it is not certain.
const ColumnFamily* likely_readings(const std::vector<ColumnFamily>& kinds) {
  const auto is_named = [](const ColumnFamily& kind) {
    return kind.columns.size() > 1 && (kind.states_places || names_readings(kind.pattern));
  };
  const auto& most = *std::ranges::max_element(
      kinds, {}, [](const ColumnFamily& kind) { return kind.columns.size(); });
  return std::ranges::count_if(kinds, is_named) == 1 && is_named(most) ? &most : nullptr;
}

/// Refuses taxels with three components, unless other columns are more.
void refuse_components(std::span<const std::string> header, const std::vector<Components>& all,
                       std::size_t others, const ReadOptions& options, const std::string& place) {
  const auto taxels = [](const Components& each) { return each.z.columns.size(); };
  const auto most = std::ranges::max_element(all, {}, taxels);
  if (most == all.end() || taxels(*most) < others) return;
  std::vector<Proposal> proposals;
  std::vector<std::string> choices;
  const Components* shown = &*most;
  for (const Components& each : all) {
    choices.push_back(choice_of(header, each.z));
    if (all.size() > 1 && !(each.is_force && taxels(each) == taxels(*most))) continue;
    proposals.push_back(proposal_of(header, each.z, options));
    shown = &each;
  }
  if (proposals.size() > 1) proposals.clear();
  throw ProposingError(
      place,
      fmt::format("has three components for each taxel, '{}', '{}', '{}', which are no readings "
                  "of sensels",
                  header[shown->x.columns[0]], header[shown->y.columns[0]],
                  header[shown->z.columns[0]]),
      fmt::format("choose the normal ones with --columns, among '{}'",
                  fmt::join(choices, "' and '")),
      "read the normal ones alone with", proposals);
}

/// Refuses names of several kinds, such as 12 pressures and a setting, or two pads.
void refuse_kinds(std::span<const std::string> header, const std::vector<ColumnFamily>& kinds,
                  bool has_components, const ReadOptions& options, const std::string& place) {
  const auto is_one = [](const ColumnFamily& kind) { return kind.columns.size() == 1; };
  if (kinds.size() < 2 || are_rows(kinds)) return;
  if (std::ranges::all_of(kinds, is_one) && !has_components) return;
  std::vector<Proposal> proposals;
  if (const ColumnFamily* const likely = likely_readings(kinds))
    proposals.push_back(proposal_of(header, *likely, options));
  throw ProposingError(place, fmt::format("has columns of several kinds: {}", list_of(kinds)),
                       "choose the readings with --columns", "choose the readings with",
                       std::move(proposals));
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
                  "choose by number, --columns FIRST-LAST");
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
    throw Error(place, fmt::format("has {} columns and none of --columns '{:.60}'", count, part),
                fmt::format("give numbers from 1 to {}", count));
  }
  for (std::size_t i = range[0]; i <= range[1]; i += range[2]) chosen.push_back(i - 1);
  return chosen;
}

/// Takes the columns that the options name; a time stays one. Numbers in names order what rises,
/// and what one part names.
void take_chosen(TableColumns& columns, std::span<const std::string> header, std::size_t count,
                 const std::string& choice, const std::string& place) {
  columns.readings.clear();
  columns.left_out.clear();
  std::vector<bool> is_known(count);
  std::vector<std::size_t> in_parts;
  for (std::size_t at = 0; at <= choice.size();) {
    const std::size_t end = std::min(choice.find(',', at), choice.size());
    const std::string part(without_blanks(std::string_view(choice).substr(at, end - at)));
    std::vector<std::size_t> chosen;
    for (const std::size_t column : columns_named(part, header, count, place)) {
      if (!is_known[column] && column != columns.time) chosen.push_back(column);
      is_known[column] = true;
    }
    columns.readings.insert(columns.readings.end(), chosen.begin(), chosen.end());
    if (!header.empty()) chosen = in_order(kinds_of(header, chosen), std::nullopt);
    in_parts.insert(in_parts.end(), chosen.begin(), chosen.end());
    at = end + 1;
  }
  columns.keeps_order = !std::ranges::is_sorted(columns.readings);
  if (columns.keeps_order) columns.readings = std::move(in_parts);
}

}  // namespace

bool has_digit(std::string_view name) {
  return name.find_first_of(kDigits) != std::string_view::npos;
}

bool count_columns(std::span<const std::string> cells) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] != std::to_string(i)) return false;
  }
  return cells.size() > 1;
}

bool names_time(std::string_view name) { return time_unit_of(name).has_value(); }

bool is_header(std::span<const std::string> cells, char separator) {
  const auto has_value = [&](const std::string& cell) {
    return !cell.empty() && is_value(cell, separator);
  };
  if (std::ranges::none_of(cells, has_value)) return true;
  if (cells.size() < 2) return false;
  const std::string& name = cells[cells[0].empty() ? 1 : 0];
  return names_time(name) || is_no_reading(name) ||
         (cells[0].empty() && count_columns(cells.subspan(1)));
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

/// "L_*', 'R_*", in the order of the rows.
std::string rows_of(const std::vector<ColumnFamily>& kinds) {
  std::vector<std::string> patterns;
  for (const ColumnFamily& kind : kinds) patterns.push_back(kind.pattern);
  return fmt::format("{}", fmt::join(patterns, "', '"));
}

/// Puts the columns in the order of their names, with the size that these state.
void take_order(TableColumns& found, std::span<const std::string> header,
                const std::vector<ColumnFamily>& kinds, const ReadOptions& options) {
  const auto& given = options.frame_size;
  const auto stated = stated_size(kinds);
  const bool is_taken = stated && options.axes.empty() &&
                        (!given || (given->rows == stated->rows && given->cols == stated->cols));
  std::vector<std::size_t> ordered = in_order(kinds, is_taken ? stated : std::nullopt);
  if (is_taken && !given) {
    found.size = stated;
    found.notes.push_back(fmt::format(
        "The names of the columns state frames of {} x {}, rows of '{}'; --shape gives another.",
        stated->rows, stated->cols, rows_of(kinds)));
  }
  const auto missing = std::ranges::count(ordered, kNoColumn);
  if (missing > 0) {
    found.notes.push_back(
        fmt::format("{} of {} places have no column and are missing.", missing, ordered.size()));
  }
  std::vector<std::size_t> present = ordered;
  std::erase(present, kNoColumn);
  if (!std::ranges::is_sorted(present)) {
    found.notes.push_back(
        fmt::format("The numbers in the names of the columns are their order, '{}' before '{}'.",
                    header[present[0]], header[present[1]]));
  }
  found.readings = std::move(ordered);
}

}  // namespace

TableColumns choose_columns(std::span<const std::string> header, std::span<const std::string> first,
                            char separator, const ReadOptions& options, const std::string& place) {
  TableColumns found = sorted_columns(header, first, separator);
  if (!options.columns.empty()) take_chosen(found, header, first.size(), options.columns, place);
  if (found.readings.empty()) {
    throw Error(place, "has no column of readings", "choose them with --columns");
  }
  if (header.empty() || long_columns(header, found, options, place)) return found;
  const std::vector<ColumnFamily> kinds = kinds_of(header, found.readings);
  std::vector<ColumnFamily> others;
  const std::vector<Components> components = components_of(kinds, others);
  std::size_t most = static_cast<std::size_t>(std::ranges::count_if(
      others, [](const ColumnFamily& kind) { return kind.columns.size() == 1; }));
  for (const ColumnFamily& kind : others) most = std::max(most, kind.columns.size());
  refuse_components(header, components, most, options, place);
  if (options.columns.empty()) refuse_kinds(header, kinds, !components.empty(), options, place);
  if (!found.keeps_order) take_order(found, header, kinds, options);
  return found;
}

std::optional<LongColumns> long_columns(std::span<const std::string> header,
                                        const TableColumns& columns, const ReadOptions& options,
                                        const std::string& place) {
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
  ColumnFamily values;
  for (const std::size_t column : columns.readings) {
    if (column != *row && column != *col) values.columns.push_back(column);
  }
  if (!values.columns.empty()) found.value = values.columns.back();
  if (!found.frame) found.frame = columns.time;
  found.row = *row;
  found.col = *col;
  if (is_named && values.columns.size() > 1) {
    const auto kinds = kinds_of(header, values.columns);
    std::vector<Proposal> proposals;
    const auto is_force = [](const ColumnFamily& kind) { return names_readings(kind.pattern); };
    const auto force = std::ranges::find_if(kinds, is_force);
    if (std::ranges::count_if(kinds, is_force) == 1) {
      proposals.push_back(proposal_of(header, *force, options));
      proposals.back().readings = 0;
    }
    throw ProposingError(place,
                         fmt::format("has rows, columns and {} readings in each line: {}",
                                     values.columns.size(), list_of(kinds)),
                         "choose one with --columns", "choose one, as with", std::move(proposals));
  }
  return values.columns.size() == 1 ? std::optional(found) : std::nullopt;
}

double likely_unit_s(double time) {
  constexpr double kMostSeconds = 1e11;
  for (const double unit_s : {1.0, 1e-3, 1e-6}) {
    if (!(std::abs(time) * unit_s > kMostSeconds)) return unit_s;
  }
  return 1e-9;
}

}  // namespace pillarfield
