#include "io/plain/table_parser.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "io/plain/column_names.h"
#include "io/plain/line_choice.h"
#include "io/plain/table_columns.h"
#include "io/plain/text_cells.h"
#include "io/proposal.h"
#include "io/tekscan/line_reader.h"
#include "pillarfield/error.h"
#include "pillarfield/skin.h"

namespace pillarfield {
namespace {

/// True if cells count 0, 1, 2, ... as the names that programs give to columns without one.
bool are_column_numbers(const std::vector<std::string>& cells) {
  if (cells.size() < 3) return false;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double number = 0;
    if (!read_cell(cells[i], ',', number) || number != static_cast<double>(i)) return false;
  }
  return true;
}

class TableParser {
 public:
  TableParser(const std::filesystem::path& path, const ReadOptions& options,
              std::uint64_t header_line)
      : path_(path),
        reader_(path, "save it as .npy"),
        options_(options),
        header_line_(header_line) {
    table_.size = options.frame_size;
  }

  Table parse() {
    bool is_first = true;
    for (std::uint64_t number = 1; !is_ended_ && reader_.next(); ++number) {
      std::string_view line = reader_.line();
      if (number == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
      if (number < header_line_ || is_comment(line)) {
        table_.words.add(line, statements_in(line, number));
        comment_ = line.substr(line.starts_with('#') ? 1 : 0);
      } else if (line.find_first_not_of(" \t\f,;") == std::string_view::npos) {
        end_block();
      } else if (std::exchange(is_first, false)) {
        add_first(line);
      } else if (header_text_.empty() || line != header_text_) {  // Each frame may have a header.
        add(line);
      }
    }
    if (held_) take_held();
    end_block();
    if (lines_) lines_->check(reader_.place());
    if (!entries_.empty()) sort_entries();
    return std::move(table_);
  }

 private:
  /// Takes the first line of the table, which may name the columns, or state the size of a frame.
  void add_first(std::string_view line) {
    separator_ = separator_of(line);
    split_cells(line, separator_, cells_);
    if (is_header(cells_, separator_)) {
      header_text_ = line;
      take_header();
      return;
    }
    std::vector<std::string> names;  // A comment above the numbers may be their names.
    split_cells(comment_, separator_, names);
    if (names.size() > 1 && names.size() == cells_.size() && is_header(names, separator_)) {
      std::swap(cells_, names);
      take_header();
      return add(line);
    }
    drop_empty_end(cells_, 2);
    double each = 0;
    if (cells_.size() == 2 && read_cell(cells_[0], separator_, each) &&
        read_cell(cells_[1], separator_, each)) {
      held_ = line;
    } else {
      add(line);
    }
  }

  void take_header() {
    header_ = cells_;
    drop_empty_end(header_, 1);
    separator_ = '\0';
  }

  /// Takes a first line of two numbers as rows and columns if their product is the length of the
  /// others, else as a line like the others.
  void take_held() {
    const std::string line = *std::exchange(held_, std::nullopt);
    double rows = 0;
    double cols = 0;
    std::vector<std::string> numbers;
    split_cells(line, separator_, numbers);
    const bool is_size = read_cell(numbers[0], separator_, rows) &&
                         read_cell(numbers[1], separator_, cols) && rows >= 2 && cols >= 2 &&
                         rows * cols == static_cast<double>(cells_.size());
    if (!is_size) return add(line);
    const FrameSize stated = {static_cast<std::uint32_t>(rows), static_cast<std::uint32_t>(cols)};
    if (!table_.size) table_.size = stated;
    table_.notes.push_back(fmt::format(
        "The first line, {} x {}, is taken as the size of a frame; --shape gives another.",
        stated.rows, stated.cols));
  }

  void add(std::string_view line) {
    if (held_) {
      split_cells(line, separator_of(line), cells_);
      drop_empty_end(cells_, 1);
      take_held();
    }
    if (separator_ == '\0') separator_ = separator_of(line);
    split_cells(line, separator_, cells_);
    if (line_cells_ == 0) {
      begin();
    } else if (header_line_ > 0 && ends_table()) {
      is_ended_ = true;
      table_.notes.push_back(fmt::format("The table ends before line {}, '{:.20}'.",
                                         reader_.number(), without_blanks(line)));
      return;
    } else {
      drop_empty_end(cells_, line_cells_);
    }
    if (cells_.size() != line_cells_) {
      throw Error(reader_.place(), fmt::format("has {} numbers", cells_.size()),
                  fmt::format("lines before it have {}", line_cells_));
    }
    if (lines_->takes(cells_)) append();
  }

  /// True if a line of words or of another table follows, as after the frames of an export.
  [[nodiscard]] bool ends_table() const {
    double value = 0;
    return cells_.size() < line_cells_ ||
           !(read_cell(cells_[0], separator_, value) || parse_time(cells_[0]));
  }

  /// Drops empty cells behind the first line of numbers: one may follow the last separator, unless
  /// the size of a frame counts it, and spreadsheets write many.
  void drop_separators() {
    if (!header_.empty()) return drop_empty_end(cells_, header_.size());
    std::vector<std::string> numbers = cells_;
    drop_empty_end(numbers, 1);
    const std::size_t empty = cells_.size() - numbers.size();
    const auto fits = [&](std::size_t count) {
      return table_.size && (count == std::size_t{table_.size->rows} * table_.size->cols ||
                             count == table_.size->cols);
    };
    if (empty == 0 || (fits(cells_.size()) && !fits(cells_.size() - 1))) return;
    if (empty == 1 || !table_.size || fits(numbers.size())) {
      cells_ = std::move(numbers);
    } else if (fits(cells_.size() - 1)) {
      cells_.pop_back();
    }
  }

  /// Takes the number and the meaning of the cells of the first line of numbers.
  void begin() {
    drop_separators();
    if (header_.empty() && cells_.front().empty()) {
      throw Error(reader_.place(), "begins with an empty cell, as a table with an index does",
                  "save it without index and header");
    }
    if (header_.size() == 1) header_.clear();  // A title.
    if (!header_.empty() && header_.size() != cells_.size()) {
      throw Error(reader_.place(), fmt::format("has {} numbers", cells_.size()),
                  fmt::format("the line of names before it has {}", header_.size()));
    }
    line_cells_ = cells_.size();
    if (header_.empty() && are_column_numbers(cells_)) {
      table_.notes.emplace_back(
          "The first line counts 0, 1, 2, ... and is read as readings. If it names columns, save "
          "the table without a header.");
    }
    columns_ = choose_columns(header_, cells_, separator_, options_, reader_.place());
    lines_.emplace(options_, header_, cells_.size(), columns_, reader_.place());
    long_columns_ = long_columns(header_, columns_, options_, reader_.place());
    for (const std::size_t column : columns_.readings) {
      if (column < header_.size()) add_unit(header_[column]);
    }
    if (!columns_.left_out.empty()) {
      table_.notes.push_back(
          fmt::format("Columns that are no readings are left out: {}; --columns chooses others.",
                      fmt::join(columns_.left_out, ", ")));
    }
    table_.cells = columns_.readings.size();
    table_.time_unit_s = columns_.time_unit_s;
    if (long_columns_) return;
    if (!table_.size) table_.size = columns_.size;
    table_.notes.insert(table_.notes.end(), columns_.notes.begin(), columns_.notes.end());
    const auto& size = table_.size;
    const std::size_t sensels = size ? std::size_t{size->rows} * size->cols : 0;
    if (!size || table_.cells == sensels || table_.cells == size->cols) return;
    const std::string needs = fmt::format("a frame of {} x {} needs {}, or rows of {}; ",
                                          size->rows, size->cols, sensels, size->cols);
    throw ProposingError(
        reader_.place(),
        fmt::format("has {} numbers, {} of them readings", line_cells_, table_.cells),
        needs + (line_cells_ > sensels ? "choose them with --columns, and name a column of times "
                                         "'time'"
                                       : "give the --shape of one frame"),
        needs + "choose them with",
        proposals_by_cells(path_, separator_, line_cells_, sensels, options_));
  }

  /// Takes the unit of pressure in a name of readings, as "left pressure 1[N/cm²]" or "p3 (kPa)".
  void add_unit(std::string name) {
    if (name.find_first_of("([") == std::string::npos && !lower_case(name).starts_with("press"))
      return;
    std::ranges::replace(name, '_', ' ');
    table_.words.add("pressure " + name, {});
  }

  void append() {
    if (table_.readings.size() + table_.cells > kMostTableReadings) {
      throw Error(reader_.place(), fmt::format("follows {} readings", table_.readings.size()),
                  "tables of at most 134217728 readings are read; save it as .npy");
    }
    const double time = columns_.time ? time_in(*columns_.time) : 0;
    ++table_.lines;
    ++block_rows_;
    if (long_columns_) return append_long(time);
    if (columns_.time) table_.times.push_back(time);
    for (const std::size_t column : columns_.readings) {
      constexpr double kMost = std::numeric_limits<float>::max();
      const double number = column == kNoColumn ? NAN : number_in(column);
      const bool is_missing = !(std::abs(number) <= kMost);
      table_.readings.push_back(is_missing ? std::numeric_limits<float>::quiet_NaN()
                                           : static_cast<float>(number));
    }
  }

  /// Takes a line that holds one reading: its frame, row and column, time and value.
  void append_long(double time) {
    const auto& columns = *long_columns_;
    const double frame = !columns.frame                   ? 0
                         : columns.frame == columns_.time ? time
                                                          : number_in(*columns.frame);
    const double row = number_in(columns.row);
    const double col = number_in(columns.col);
    const auto is_place = [](double number) {
      return number >= 0 && number <= kMaxSensels && number == std::floor(number);
    };
    if (!is_place(row) || !is_place(col) || std::isnan(frame)) {
      throw Error(reader_.place(),
                  fmt::format("has a reading in row {}, column {} of frame {}", row, col, frame),
                  fmt::format("rows and columns are whole numbers up to {}", kMaxSensels));
    }
    if (entries_.size() == kMostTableReadings / 4) {
      throw Error(reader_.place(), "follows 33554432 lines of one reading", "save it as .npy");
    }
    entries_.push_back({frame, row, col, time, number_in(columns.value)});
  }

  /// Puts the readings of single lines in order; cells without one are missing.
  void sort_entries() {
    std::ranges::sort(entries_, {}, [](const auto& entry) {
      return std::array{entry[0], entry[1], entry[2]};
    });
    double first = kMaxSensels;
    double last_row = 0;
    double last_col = 0;
    const std::array<double, 5>* before = nullptr;
    for (const auto& entry : entries_) {
      const auto& [frame, row, col, time, value] = entry;
      first = std::min({first, row, col});
      last_row = std::max(last_row, row);
      last_col = std::max(last_col, col);
      if (before == nullptr || frame != before->at(0)) table_.times.push_back(time);
      if (before != nullptr && std::equal(before->begin(), before->begin() + 3, entry.begin())) {
        throw Error(reader_.place(),
                    fmt::format("the table has two readings in row {}, column {} of frame {}", row,
                                col, frame),
                    "give each frame its own number or time");
      }
      before = &entry;
    }
    first = std::min(first, 1.0);
    const auto rows = static_cast<std::uint64_t>(last_row - first) + 1;
    const auto cols = static_cast<std::uint64_t>(last_col - first) + 1;
    table_.long_shape = {table_.times.size(), rows, cols};
    if (table_.times.size() > kMostTableReadings / (rows * cols)) {
      throw Error(
          reader_.place(),
          fmt::format("the table has {} frames of {} x {}", table_.times.size(), rows, cols),
          "tables of at most 134217728 readings are read; save it as .npy");
    }
    table_.readings.assign(table_.times.size() * rows * cols,
                           std::numeric_limits<float>::quiet_NaN());
    std::size_t frame = 0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const auto& entry = entries_[i];
      if (i > 0 && entry[0] != entries_[i - 1][0]) ++frame;
      const auto row = static_cast<std::size_t>(entry[1] - first);
      const auto col = static_cast<std::size_t>(entry[2] - first);
      table_.readings[(frame * rows + row) * cols + col] = static_cast<float>(entry[4]);
    }
    if (!columns_.time) table_.times.clear();
    table_.notes.push_back(fmt::format(
        "Each line is one reading, '{}', at its row and column, which count from {}; {} are "
        "missing.",
        header_[long_columns_->value], first, table_.readings.size() - entries_.size()));
  }

  [[nodiscard]] double number_in(std::size_t column) const {
    double value = 0;
    if (read_cell(cells_[column], separator_, value)) return value;
    throw Error(reader_.place(),
                fmt::format("'{:.30}' in column {} is not a number", cells_[column], column + 1),
                "write a number, and nan or nothing for a missing reading, or leave the column out "
                "with --columns");
  }

  [[nodiscard]] double time_in(std::size_t column) {
    const std::string& cell = cells_[column];
    if (table_.lines == 0) is_clock_ = parse_time(cell).has_value();
    if (!is_clock_) return number_in(column);
    if (const auto time_s = parse_time(cell)) return rising_(*time_s);
    throw Error(reader_.place(),
                fmt::format("'{:.40}' in column {} is not a time", cell, column + 1),
                "write it as 2024-05-01 12:00:00.015 or 12:00:00.015");
  }

  void end_block() {
    if (block_rows_ == 0) return;
    if (table_.blocks == 0) table_.rows = block_rows_;
    if (block_rows_ != table_.rows && !table_.size && !long_columns_) {
      throw Error(reader_.place(), fmt::format("a frame of {} rows ends here", block_rows_),
                  fmt::format("frames before it have {}", table_.rows));
    }
    ++table_.blocks;
    block_rows_ = 0;
  }

  const std::filesystem::path& path_;
  LineReader reader_;
  const ReadOptions& options_;
  std::uint64_t header_line_;
  std::optional<LineChoice> lines_;
  Table table_;
  char separator_ = '\0';
  std::string comment_;  // the last one
  std::string header_text_;
  std::vector<std::string> header_;
  std::optional<std::string> held_;  // a first line of two numbers
  TableColumns columns_;
  std::optional<LongColumns> long_columns_;
  std::vector<std::array<double, 5>> entries_;  // frame, row, column, time, value
  std::vector<std::string> cells_;
  std::size_t line_cells_ = 0;    // of the first line
  std::uint64_t block_rows_ = 0;  // of the block so far
  bool is_clock_ = false;
  bool is_ended_ = false;
  RisingClock rising_;
};

}  // namespace

bool is_comment(std::string_view line) {
  return line.starts_with('#') || lower_case(line.substr(0, 4)) == "sep=";
}

Table parse_table(const std::filesystem::path& path, const ReadOptions& options,
                  std::uint64_t header_line) {
  return TableParser(path, options, header_line).parse();
}

}  // namespace pillarfield
