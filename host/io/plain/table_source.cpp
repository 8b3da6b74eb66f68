// Frames in a text file: numbers separated by commas, semicolons, tabs or blanks.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "base/input_file.h"
#include "io/force_sink.h"
#include "io/frame_source.h"
#include "io/plain/source.h"
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

/// Calls `action` with each cell of a line, without blanks around it.
template <class Action>
void for_each_cell(std::string_view line, char separator, Action action) {
  line = without_blanks(line, separator == '\t' ? " " : kBlanks);  // Outer cells may be empty.
  while (true) {
    const std::size_t end = std::min(line.find(separator), line.size());
    action(without_blanks(line.substr(0, end)));
    if (end == line.size()) return;
    line.remove_prefix(end + 1);
    if (separator == ' ') line = without_blanks(line);
  }
}

/// Reads a number; an empty cell is a missing reading, NaN.
bool read_cell(std::string_view cell, double& value) {
  if (cell.empty()) {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  if (cell.starts_with('+')) cell.remove_prefix(1);
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc{} && end == cell.data() + cell.size();
}

/// Whether a line has names, and no number.
bool is_names(std::string_view line) {
  bool has_number = false;
  for_each_cell(line, separator_of(line), [&](std::string_view cell) {
    double value = 0;
    has_number = has_number || (!cell.empty() && read_cell(cell, value));
  });
  return !has_number;
}

/// Whether a line has several cells and no letter that numbers lack, for recognising a table.
bool resembles_numbers(std::string_view line) {
  return line.find_first_of("0123456789") != std::string_view::npos &&
         line.find_first_not_of("0123456789+-.,; \teEnaNifIF") == std::string_view::npos &&
         without_blanks(line).find(separator_of(line)) != std::string_view::npos;
}

/// Whether cells count 0, 1, 2, ... as the names that programs give to columns without one.
bool are_column_numbers(const std::vector<double>& cells) {
  if (cells.size() < 3) return false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] != static_cast<double>(i)) return false;
  }
  return true;
}

bool is_comment(std::string_view line) { return line.starts_with('#'); }

/// Readings and times of a table.
struct Table {
  std::vector<float> readings;
  std::vector<double> times_s;
  std::uint64_t lines = 0;   ///< with numbers
  std::uint64_t blocks = 0;  ///< of lines, between blank ones
  std::size_t cells = 0;     ///< of a line, without its time
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
      } else if (!std::exchange(is_first, false) || !is_names(line)) {
        add(line);
      }
    }
    end_block();
    return std::move(table_);
  }

  /// Rows of each block of lines.
  [[nodiscard]] std::uint64_t rows() const { return rows_; }

 private:
  void add(std::string_view line) {
    if (separator_ == '\0') separator_ = separator_of(line);
    cells_.clear();
    for_each_cell(line, separator_, [&](std::string_view cell) {
      double value = 0;
      if (!read_cell(cell, value)) {
        throw Error(reader_.place(),
                    fmt::format("'{:.30}' in column {} is not a number", cell, cells_.size() + 1),
                    "write numbers with decimal points, and nan for a missing reading");
      }
      if (cells_.empty()) has_empty_begin_ = cell.empty();
      has_empty_end_ = cell.empty();
      cells_.push_back(value);
    });
    // A separator may follow the last cell.
    const bool is_known = line_cells_ != 0;
    if (has_empty_end_ && cells_.size() > 1 && (!is_known || cells_.size() == line_cells_ + 1)) {
      cells_.pop_back();
    }
    if (!is_known) {
      table_.begins_with_column_numbers = are_column_numbers(cells_);
      begin();
    }
    if (cells_.size() != line_cells_) {
      throw Error(reader_.place(), fmt::format("has {} numbers", cells_.size()),
                  fmt::format("lines before it have {}", line_cells_));
    }
    append();
  }

  /// Takes the number of cells of the first line.
  void begin() {
    if (has_empty_begin_) {
      throw Error(reader_.place(), "begins with an empty cell, as a table with an index does",
                  "save it without index and header");
    }
    line_cells_ = cells_.size();
    table_.cells = line_cells_;
    if (!size_) return;
    const std::size_t sensels = std::size_t{size_->rows} * size_->cols;
    has_times_ = line_cells_ == sensels + 1;
    table_.cells -= has_times_ ? 1 : 0;
    if (table_.cells == sensels || table_.cells == size_->cols) return;
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
    if (has_times_) table_.times_s.push_back(cells_.front());
    for (std::size_t i = has_times_ ? 1 : 0; i < cells_.size(); ++i) {
      constexpr double kMost = std::numeric_limits<float>::max();
      const bool is_missing = !(std::abs(cells_[i]) <= kMost);
      table_.readings.push_back(is_missing ? std::numeric_limits<float>::quiet_NaN()
                                           : static_cast<float>(cells_[i]));
    }
    ++table_.lines;
    ++block_rows_;
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
  std::vector<double> cells_;
  bool has_empty_begin_ = false;
  bool has_empty_end_ = false;
  bool has_times_ = false;
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

std::unique_ptr<FileSource> open_table(const std::filesystem::path& path,
                                       const ReadOptions& options) {
  refuse_dataset(path, options);
  refuse_output(path);
  TableParser parser(path, options.frame_size);
  Table table = parser.parse();
  std::vector<std::uint64_t> shape = shape_of(table, parser.rows(), path, options.frame_size);
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
                   std::move(table.times_s), known);
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
