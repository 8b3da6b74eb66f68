// Frames in a text file: numbers separated by commas, semicolons, tabs or blanks.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "base/input_file.h"
#include "io/force_sink.h"
#include "io/frame_source.h"
#include "io/plain/source.h"
#include "io/plain/table_columns.h"
#include "io/tekscan/line_reader.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// Most readings of a table: 512 MiB of them.
constexpr std::size_t kMostTableReadings = std::size_t{1} << 27U;

constexpr std::string_view kBlanks = " \t";

std::string_view without_blanks(std::string_view text, std::string_view blanks = kBlanks) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// The separator of a line's cells; ' ' for any number of blanks.
char separator_of(std::string_view line) {
  for (const char separator : {';', '\t', ','}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

std::string_view without_quotes(std::string_view cell) {
  const bool is_quoted = cell.size() > 1 && cell.starts_with('"') && cell.ends_with('"');
  return is_quoted ? cell.substr(1, cell.size() - 2) : cell;
}

/// Where the first cell of a line ends. Between blanks, a date and the time after it are one cell.
std::size_t end_of_cell(std::string_view line, char separator) {
  const std::size_t end = std::min(line.find(separator), line.size());
  if (separator != ' ' || end == line.size()) return end;
  const std::size_t end_of_time = std::min(line.find(separator, end + 1), line.size());
  return parse_iso_time(line.substr(0, end_of_time)) ? end_of_time : end;
}

/// Calls `action` with each cell of a line, without blanks and quotes around it.
template <class Action>
void for_each_cell(std::string_view line, char separator, Action action) {
  line = without_blanks(line, separator == '\t' ? " " : kBlanks);  // Outer cells may be empty.
  while (true) {
    const std::size_t end = end_of_cell(line, separator);
    action(without_quotes(without_blanks(line.substr(0, end))));
    if (end == line.size()) return;
    line.remove_prefix(end + 1);
    if (separator == ' ') line = without_blanks(line);
  }
}

/// Whether a line has several cells, and no letter but in a time that numbers lack, for recognising
/// a table.
bool resembles_numbers(std::string_view line) {
  const char separator = separator_of(line);
  if (line.find_first_of("0123456789") == std::string_view::npos ||
      without_blanks(line).find(separator) == std::string_view::npos) {
    return false;
  }
  bool is_number = true;
  for_each_cell(line, separator, [&](std::string_view cell) {
    is_number = is_number &&
                (cell.find_first_not_of("0123456789+-.,; \teEnaNifIF") == std::string_view::npos ||
                 parse_iso_time(cell));
  });
  return is_number;
}

/// Whether cells count 0, 1, 2, ... as the names that programs give to columns without one.
bool are_column_numbers(const std::vector<std::string>& cells) {
  if (cells.size() < 3) return false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double number = 0;
    if (!read_cell(cells[i], number) || number != static_cast<double>(i)) return false;
  }
  return true;
}

bool is_comment(std::string_view line) { return line.starts_with('#'); }

/// Readings and times of a table.
struct Table {
  std::vector<float> readings;
  std::vector<double> times;  ///< of each line, or none
  double time_unit_s = 0;     ///< 0 if the column states none
  std::uint64_t lines = 0;    ///< with numbers
  std::uint64_t blocks = 0;   ///< of lines, between blank ones
  std::size_t cells = 0;      ///< of a line, without those before the readings
  bool begins_with_column_numbers = false;
};

class TableParser {
 public:
  TableParser(const std::filesystem::path& path, const std::optional<FrameSize>& size)
      : reader_(path, "save it as .npy"), size_(size) {}

  Table parse() {
    bool is_first = true;
    while (reader_.next()) {
      std::string_view line = reader_.line();
      if (is_first && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
      if (is_comment(line)) continue;
      if (without_blanks(line).empty()) {
        end_block();
      } else if (std::exchange(is_first, false)) {
        add_first(line);
      } else if (header_line_.empty() || line != header_line_) {  // Each frame may have a header.
        add(line);
      }
    }
    end_block();
    return std::move(table_);
  }

  /// Rows of each block of lines.
  [[nodiscard]] std::uint64_t rows() const { return rows_; }

 private:
  void split(std::string_view line) {
    std::size_t count = 0;
    for_each_cell(line, separator_, [&](std::string_view cell) {
      if (count == cells_.size()) cells_.emplace_back();
      cells_[count++] = cell;
    });
    cells_.resize(count);
  }

  /// Takes the first line of the table, which may name the columns.
  void add_first(std::string_view line) {
    separator_ = separator_of(line);
    split(line);
    if (!is_header(cells_)) return add(line);
    header_line_ = line;
    header_ = cells_;
    if (header_.size() > 1 && header_.back().empty()) header_.pop_back();
    separator_ = '\0';
  }

  void add(std::string_view line) {
    if (separator_ == '\0') separator_ = separator_of(line);
    split(line);
    const bool is_known = line_cells_ != 0;
    if (is_known ? cells_.size() == line_cells_ + 1 : ends_with_separator()) {
      if (cells_.back().empty()) cells_.pop_back();
    }
    if (!is_known) begin();
    if (cells_.size() != line_cells_) {
      throw Error(reader_.place(), fmt::format("has {} numbers", cells_.size()),
                  fmt::format("lines before it have {}", line_cells_));
    }
    append();
  }

  /// Whether an empty cell at the end of the first line is none: a separator may follow the last
  /// cell, unless the size of a frame or the header counts it.
  [[nodiscard]] bool ends_with_separator() const {
    const std::size_t count = cells_.size();
    if (count < 2) return false;
    if (size_ && fits(count - 1)) return true;
    return size_ ? !fits(count) : count != header_.size();
  }

  /// Whether a line of so many cells holds a frame, with its time or without, or a row of it.
  [[nodiscard]] bool fits(std::size_t count) const {
    const std::size_t leading = find_leading_columns(header_, cells_).count;
    const std::size_t sensels = std::size_t{size_->rows} * size_->cols;
    return count == leading + sensels || count == leading + size_->cols ||
           (leading == 0 && count == sensels + 1);
  }

  /// Takes the number and the meaning of the cells of the first line of numbers.
  void begin() {
    if (cells_.front().empty()) {
      throw Error(reader_.place(), "begins with an empty cell, as a table with an index does",
                  "save it without index and header");
    }
    line_cells_ = cells_.size();
    table_.begins_with_column_numbers = are_column_numbers(cells_);
    leading_ = find_leading_columns(header_, cells_);
    const std::size_t sensels = size_ ? std::size_t{size_->rows} * size_->cols : 0;
    if (size_ && leading_.count == 0 && line_cells_ == sensels + 1) {
      leading_ = {.count = 1, .time = 0};
    }
    table_.cells = line_cells_ - leading_.count;
    table_.time_unit_s = leading_.unit_s;
    if (!size_ || table_.cells == sensels || table_.cells == size_->cols) return;
    throw Error(reader_.place(), fmt::format("has {} numbers", line_cells_),
                fmt::format("a frame of {} x {} needs {}, or {} with its time before them, or rows "
                            "of {}",
                            size_->rows, size_->cols, sensels, sensels + 1, size_->cols));
  }

  void append() {
    if (table_.readings.size() + table_.cells > kMostTableReadings) {
      throw Error(reader_.place(), fmt::format("follows {} readings", table_.readings.size()),
                  "tables of at most 134217728 readings are read; save it as .npy");
    }
    if (leading_.time) add_time();
    for (std::size_t i = leading_.count; i < cells_.size(); ++i) {
      constexpr double kMost = std::numeric_limits<float>::max();
      const double number = number_in(i);
      const bool is_missing = !(std::abs(number) <= kMost);
      table_.readings.push_back(is_missing ? std::numeric_limits<float>::quiet_NaN()
                                           : static_cast<float>(number));
    }
    ++table_.lines;
    ++block_rows_;
  }

  [[nodiscard]] double number_in(std::size_t column) const {
    double value = 0;
    if (read_cell(cells_[column], value)) return value;
    throw Error(reader_.place(),
                fmt::format("'{:.30}' in column {} is not a number", cells_[column], column + 1),
                "write numbers with decimal points, and nan for a missing reading");
  }

  void add_time() {
    const std::string& cell = cells_[*leading_.time];
    if (!leading_.is_iso) {
      table_.times.push_back(number_in(*leading_.time));
    } else if (const auto time_s = parse_iso_time(cell)) {
      table_.times.push_back(*time_s);
      table_.time_unit_s = 1;
    } else {
      throw Error(reader_.place(),
                  fmt::format("'{:.40}' in column {} is not a time", cell, *leading_.time + 1),
                  "write it as 2024-05-01 12:00:00.015");
    }
  }

  void end_block() {
    if (block_rows_ == 0) return;
    if (table_.blocks == 0) rows_ = block_rows_;
    if (block_rows_ != rows_ && !size_) {
      throw Error(reader_.place(), fmt::format("a frame of {} rows ends here", block_rows_),
                  fmt::format("frames before it have {}", rows_));
    }
    ++table_.blocks;
    block_rows_ = 0;
  }

  LineReader reader_;
  std::optional<FrameSize> size_;
  Table table_;
  char separator_ = '\0';
  std::string header_line_;
  std::vector<std::string> header_;
  LeadingColumns leading_;
  std::vector<std::string> cells_;
  std::size_t line_cells_ = 0;    // of the first line
  std::uint64_t block_rows_ = 0;  // of the block so far
  std::uint64_t rows_ = 0;        // of the first block
};

/// Whether all readings are whole numbers of 16 bits.
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
std::vector<std::uint64_t> shape_of(const Table& table, std::uint64_t rows,
                                    const std::filesystem::path& path,
                                    const std::optional<FrameSize>& size) {
  if (table.lines == 0) throw Error(path.string(), "holds no numbers", "give a table of readings");
  if (!size) {
    if (table.blocks == 1 && !table.times.empty()) {
      throw Error(path.string(), "has a time in each line",
                  "give the size of a frame, --shape ROWSxCOLS");
    }
    if (table.blocks == 1) return {table.lines, table.cells};
    return {table.blocks, rows, table.cells};
  }
  if (table.cells != size->cols) return {table.lines, table.cells};
  if (table.lines % size->rows == 0) return {table.lines / size->rows, size->rows, size->cols};
  throw Error(path.string(), fmt::format("holds {} rows", table.lines),
              fmt::format("frames of {} rows need a multiple", size->rows));
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
  refuse_dataset(path, options);
  refuse_output(path);
  TableParser parser(path, options.frame_size);
  Table table = parser.parse();
  std::vector<std::uint64_t> shape = shape_of(table, parser.rows(), path, options.frame_size);
  const std::uint64_t frame_lines = table.lines / shape.front();
  const double unit_s = unit_of(table);
  const bool is_counts = are_counts(table.readings);
  const NumberType type = is_counts ? NumberType{NumberType::Kind::unsigned_integer, 2}
                                    : NumberType{NumberType::Kind::real, 4};
  std::vector<std::byte> numbers = is_counts ? bytes_of_readings<std::uint16_t>(table.readings)
                                             : bytes_of_readings<float>(table.readings);
  ReadOptions known = options;
  using enum ArrayAxis;  // Blank lines separate frames.
  if (known.axes.empty() && shape.size() == 3) known.axes = {frames, rows, columns};
  auto source =
      array_source(path, "table of numbers",
                   array_in_memory(path.string(), type, std::move(shape), std::move(numbers)),
                   times_of(table, frame_lines, unit_s), known);
  warn_of_unit(*source, table, unit_s);
  if (table.begins_with_column_numbers) {
    source->warn(
        "The first line counts 0, 1, 2, ... and is read as readings. If it names columns, save the "
        "table without a header.");
  }
  return source;
}

/// Whether a text begins with two or more numbers in a line, after a line of names or none.
bool looks_like_table(std::string_view head) {
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  const auto is_text = [](char letter) {
    return static_cast<unsigned char>(letter) >= ' ' || letter == '\t' || letter == '\n' ||
           letter == '\r';
  };
  if (!std::ranges::all_of(head, is_text)) return false;
  for (int tried = 0; tried < 2 && !head.empty();) {
    const std::size_t end = std::min(head.find('\n'), head.size());
    std::string_view line = head.substr(0, end);
    const bool is_cut = end == head.size();
    head.remove_prefix(std::min(end + 1, head.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (is_comment(line) || without_blanks(line).empty()) continue;
    const char separator = separator_of(line);
    // The last cell of a line that the head cuts is left out.
    if (is_cut) line = line.substr(0, line.find_last_of(separator));
    if (resembles_numbers(line)) return true;
    // A line of names may be longer than the head.
    constexpr std::ptrdiff_t kManyNames = 100;
    if (is_cut && separator != ' ' && std::ranges::count(line, separator) >= kManyNames)
      return true;
    ++tried;
  }
  return false;
}

}  // namespace

SourceFormat table_format() {
  return {.name = "table of numbers (CSV)", .recognises = looks_like_table, .open = open_table};
}

}  // namespace pillarfield
