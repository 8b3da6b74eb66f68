// Frames in a text file: numbers separated by commas, semicolons, tabs or blanks.

#include "io/plain/table_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/input_file.h"
#include "io/force_sink.h"
#include "io/frame_source.h"
#include "io/plain/source.h"
#include "io/plain/table_columns.h"
#include "io/plain/table_parser.h"
#include "io/plain/text_cells.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// True if a line has cells, all of them numbers, times or missing, for recognising a
/// table.
bool resembles_numbers(std::string_view line) {
  std::vector<std::string> cells;
  const char separator = separator_of(line);
  split_cells(line, separator, cells);
  return has_digit(line) && std::ranges::all_of(cells, [&](const std::string& cell) {
           return is_value(cell, separator);
         });
}

/// True if all readings are whole numbers of 16 bits.
bool are_counts(const std::vector<float>& readings) {
  return std::ranges::all_of(readings, [](float reading) {
    return reading >= 0 && reading <= 65535 && reading == std::floor(reading);
  });
}

template <class Reading>
std::vector<std::byte> bytes_of_readings(const std::vector<float>& readings) {
  std::vector<std::byte> bytes(readings.size() * sizeof(Reading));
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto reading = static_cast<Reading>(readings[i]);
    std::memcpy(bytes.data() + i * sizeof reading, &reading, sizeof reading);
  }
  return bytes;
}

/// The array that the lines of a table form.
std::vector<std::uint64_t> shape_of(const Table& table, const std::filesystem::path& path) {
  if (table.lines == 0) throw Error(path.string(), "holds no numbers", "give a table of readings");
  if (!table.long_shape.empty()) return table.long_shape;
  if (!table.size) {
    if (table.blocks == 1 && !table.times.empty()) {
      throw Error(path.string(),
                  fmt::format("has a time in each line and {} readings", table.cells),
                  "give the size of a frame, --shape ROWSxCOLS");
    }
    if (table.blocks == 1) return {table.lines, table.cells};
    return {table.blocks, table.rows, table.cells};
  }
  if (table.cells != table.size->cols) return {table.lines, table.cells};
  if (table.lines % table.size->rows == 0)
    return {table.lines / table.size->rows, table.size->rows, table.size->cols};
  throw Error(path.string(), fmt::format("holds {} rows", table.lines),
              fmt::format("frames of {} rows need a multiple", table.size->rows));
}

/// Throws Error for a table of forces or contacts.
void refuse_output(const std::filesystem::path& path) {
  const SinkFormat* const format = format_by_beginning(InputFile(path).text_at(0, 1024));
  if (format == nullptr) return;
  throw Error(path.string(), format->content, "give the readings that it was solved from");
}

/// The unit of the times, s.
double unit_of(const Table& table) {
  if (table.time_unit_s > 0) return table.time_unit_s;
  return table.times.empty() ? 1 : likely_unit_s(table.times.front());
}

/// The times of the frames, of which each has so many lines.
std::vector<double> times_of(const Table& table, std::uint64_t frame_lines, double unit_s) {
  std::vector<double> times_s;
  for (std::size_t line = 0; line < table.times.size(); line += frame_lines) {
    times_s.push_back(table.times[line] * unit_s);
  }
  return times_s;
}

/// Warns of times whose unit is assumed, if it is not seconds or hardly that.
void warn_of_unit(FileSource& source, const Table& table, double unit_s) {
  if (table.times.empty() || table.time_unit_s > 0) return;
  if (unit_s < 1) {
    source.warn(fmt::format("Times are taken as {} since 1970.", unit_s == 1e-3   ? "milliseconds"
                                                                 : unit_s == 1e-6 ? "microseconds"
                                                                                  : "nanoseconds"));
    return;
  }
  constexpr double kLongIntervalS = 1;
  const std::uint64_t last = source.frames() - 1;
  const double interval_s = (source.time(last) - source.time(0)) / static_cast<double>(last);
  if (!(interval_s > kLongIntervalS)) return;
  source.warn(fmt::format(
      "Frames are {:.3g} s apart. If their times are milliseconds, name the column time_ms.",
      interval_s));
}

std::unique_ptr<FileSource> open_table(const std::filesystem::path& path,
                                       const ReadOptions& options) {
  return open_table_after(path, options, 0);
}

/// True if a text begins with two or more numbers in a line, after a line of names or none.
bool looks_like_table(std::string_view head) {
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  const auto is_text = [](char letter) {
    return static_cast<unsigned char>(letter) >= ' ' || letter == '\t' || letter == '\n' ||
           letter == '\r';
  };
  if (!std::ranges::all_of(head, is_text)) return false;
  // The numbers of JSON and XML are no cells.
  if (head.starts_with("[[") || head.starts_with('{')) return false;
  if (head.starts_with('<') && head.find("</") != std::string_view::npos) return false;
  std::size_t names = 0;  // of the line before
  char names_separator = '\0';
  for (int tried = 0; tried < 2 && !head.empty();) {
    const std::size_t end = std::min(head.find('\n'), head.size());
    std::string_view line = head.substr(0, end);
    const bool is_cut = end == head.size();
    head.remove_prefix(std::min(end + 1, head.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    (void)take_stamp(line);
    if (is_comment(line) || is_blank_or_rule(line)) continue;
    const char separator = separator_of(line);
    // The last cell of a line that the head cuts is left out.
    if (is_cut) line = line.substr(0, line.find_last_of(separator));
    std::vector<std::string> cells;
    split_cells(line, separator, cells);
    drop_empty_end(cells);
    const auto numbers = std::ranges::count_if(cells, [&](const std::string& cell) {
      double value = 0;
      return read_cell(cell, separator, value);
    });
    // "Frame 7" names no columns.
    if (names == 2 && cells.size() == 2 && names_separator != separator) return false;
    const bool has_names = names == cells.size() && numbers > 2 && 2 * numbers > std::ssize(cells);
    if (has_names || resembles_numbers(line))
      return has_names || names == 0 || names + 2 > cells.size() || cells.size() < 4;
    names = cells.size();
    names_separator = separator;
    // A line of names may be longer than the head.
    constexpr std::ptrdiff_t kManyNames = 100;
    if (is_cut && separator != ' ' && std::ranges::count(line, separator) >= kManyNames)
      return true;
    ++tried;
  }
  return false;
}

}  // namespace

std::unique_ptr<NumberArray> array_of(const std::vector<float>& readings,
                                      std::vector<std::uint64_t> shape, std::string place) {
  const bool is_counts = are_counts(readings);
  return array_in_memory(
      std::move(place),
      is_counts ? NumberType{NumberType::Kind::unsigned_integer, 2}
                : NumberType{NumberType::Kind::real, 4},
      std::move(shape),
      is_counts ? bytes_of_readings<std::uint16_t>(readings) : bytes_of_readings<float>(readings));
}

std::unique_ptr<FileSource> open_table_after(const std::filesystem::path& path,
                                             const ReadOptions& options, std::uint64_t line) {
  if (!options.dataset.empty()) refuse_dataset(path, options);
  refuse_output(path);
  Table table = parse_table(path, options, line);
  if (table.has_words_between && line == 0) {
    if (auto frames = open_frames_between_words(path, options)) return frames;
  }
  if (table.refusal) throw Error(*table.refusal);
  std::vector<std::uint64_t> shape = shape_of(table, path);
  ReadOptions known = options;
  known.columns.clear();
  known.where.clear();
  known.frame_size = table.size;
  if (const auto newtons =
          table.words.newtons_per_cell(std::nullopt, known, table.notes, path.string())) {
    for (float& reading : table.readings) reading = static_cast<float>(reading * *newtons);
  }
  known.readings.clear();
  known.times.clear();
  const std::uint64_t frame_lines =
      table.long_shape.empty() ? table.lines / shape.front() : std::uint64_t{1};
  const double unit_s = unit_of(table);
  using enum ArrayAxis;  // Blank lines separate frames.
  if (known.axes.empty() && shape.size() == 3) known.axes = {frames, rows, columns};
  auto source = array_source(path, "table of numbers",
                             array_of(table.readings, std::move(shape), path.string()),
                             times_of(table, frame_lines, unit_s), known);
  warn_of_unit(*source, table, unit_s);
  for (std::string& note : table.notes) source->warn(std::move(note));
  return source;
}

SourceFormat table_format() {
  return {.name = "table of numbers (CSV)", .recognises = looks_like_table, .open = open_table};
}

}  // namespace pillarfield
