#include "io/plain/table_parser.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "io/plain/column_names.h"
#include "io/plain/line_choice.h"
#include "io/plain/table_columns.h"
#include "io/plain/text_cells.h"
#include "io/proposal.h"
#include "io/tekscan/line_reader.h"
#include "io/units.h"
#include "pillarfield/error.h"
#include "pillarfield/skin.h"

namespace pillarfield {
namespace {

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
    find_length();
    while (!is_ended_ && reader_.next()) {
      std::string_view line = reader_.line();
      if (reader_.number() == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
      stamp_s_ = take_stamp(line);
      if (reader_.number() < header_line_ || is_comment(line)) {
        add_words(line);
        comment_ = line.substr(std::min(line.find_first_not_of("#%/"), line.size()));
      } else if (is_blank_or_rule(line)) {
        end_block();
      } else if (line_cells_ == 0) {
        add_first(line);
      } else if (header_text_.empty() || line != header_text_) {  // Each frame may have a header.
        add(line);
      }
    }
    end_block();
    if (lines_) lines_->check(reader_.place());
    finish();
    if (!entries_.empty()) sort_entries();
    return std::move(table_);
  }

 private:
  /// Finds the usual number of cells in the first lines of numbers.
  void find_length() {
    constexpr int kLooks = 100;
    LineReader reader(reader_.path(), "save it as .npy");
    std::map<std::size_t, int> lengths;
    std::vector<std::string> cells;
    for (int looks = 0; looks < kLooks && reader.next();) {
      std::string_view line = reader.line();
      (void)take_stamp(line);
      const char separator = separator_of(line);
      if (reader.number() < header_line_ || is_comment(line) || is_blank_or_rule(line)) continue;
      split_cells(line, separator, cells);
      if (!are_numbers(cells, separator)) continue;
      ++looks;
      if (++lengths[cells.size()] > lengths[length_]) length_ = cells.size();
    }
  }

  /// True if most cells are numbers or times.
  static bool are_numbers(const std::vector<std::string>& cells, char separator) {
    std::size_t numbers = 0;  // missing ones, too
    std::size_t finite = 0;
    for (const std::string& cell : cells) {
      double value = 0;
      const bool is_number = read_cell(cell, separator, value) || parse_time(cell);
      numbers += is_number;
      finite += is_number && std::isfinite(value);
    }
    return 2 * numbers > cells.size() && (finite > 0 || numbers == cells.size());
  }

  void add_words(std::string_view line) {
    table_.words.add(line, statements_in(line, reader_.number()));
  }

  /// Takes a line before the first one of numbers, which may name the columns, or state the size of
  /// a frame.
  void add_first(std::string_view line) {
    separator_ = separator_of(line);
    split_cells(line, separator_, cells_);
    if (is_header(cells_, separator_)) {
      add_words(header_text_);
      header_text_ = line;
      header_ = cells_;
      drop_empty_end(header_, 1);
      return;
    }
    std::vector<std::string> cells = cells_;
    drop_empty_end(cells, header_.size());
    const bool is_named = header_.size() > 1 && header_.size() == cells.size() &&
                          std::ranges::any_of(cells, [&](const std::string& cell) {
                            double value = 0;
                            return read_cell(cell, separator_, value) && std::isfinite(value);
                          });
    if (!is_named && !are_numbers(cells_, separator_)) return add_words(line);
    if (cells_.size() != length_ && !is_named) {
      if (held_ || cells_.size() != 2) leave_out(line);
      if (cells_.size() == 2) held_ = line;
      return;
    }
    std::vector<std::string> names;  // A comment above the numbers may be their names.
    split_cells(comment_, separator_, names);
    if (header_.empty() && names.size() > 1 && names.size() == cells_.size() &&
        is_header(names, separator_)) {
      header_ = std::move(names);
    }
    begin();
    if (line_cells_ > 0 && lines_->takes(cells_)) append();
  }

  /// Takes a first line of two numbers as rows and columns if their product is the number of
  /// readings in the others.
  void take_held() {
    const std::string line = *std::exchange(held_, std::nullopt);
    double rows = 0;
    double cols = 0;
    std::vector<std::string> numbers;
    split_cells(line, separator_of(line), numbers);
    const bool is_size = read_cell(numbers[0], separator_of(line), rows) &&
                         read_cell(numbers[1], separator_of(line), cols) && rows >= 1 &&
                         rows * cols == static_cast<double>(table_.cells);
    if (!is_size) return leave_out(line);
    const FrameSize stated = {static_cast<std::uint32_t>(rows), static_cast<std::uint32_t>(cols)};
    if (!table_.size) table_.size = stated;
    table_.notes.push_back(fmt::format(
        "The first line, {} x {}, is taken as the size of a frame; --shape gives another.",
        stated.rows, stated.cols));
  }

  void add(std::string_view line) {
    split_cells(line, separator_, cells_);
    if (header_line_ > 0 && ends_table()) {
      is_ended_ = true;
      table_.notes.push_back(fmt::format("The table ends before line {}, '{:.20}'.",
                                         reader_.number(), without_blanks(line)));
      return;
    }
    drop_empty_end(cells_, line_cells_);
    const auto is_read = [&](const std::string& cell) { return is_value(cell, separator_); };
    if (cells_.size() != line_cells_ || std::ranges::none_of(cells_, is_read))
      return leave_out(line);
    if (lines_->takes(cells_)) append();
  }

  /// Leaves out a line of words or one that is cut.
  void leave_out(std::string_view line) {
    const bool has_word = !std::ranges::all_of(
        cells_, [&](const std::string& cell) { return is_value(cell, separator_); });
    if (has_word) add_words(line);
    if (left_out_++ == 0)
      first_left_out_ = fmt::format("'{:.30}' in line {}", without_blanks(line), reader_.number());
    (has_word ? words_since_ : cut_since_) = true;
    if (!has_word && cut_.empty()) {
      cut_ = reader_.place();
      cut_cells_ = cells_.size();
    }
  }

  /// True if a line of words or of another table follows, as after the frames of an export.
  [[nodiscard]] bool ends_table() const {
    return cells_.size() < line_cells_ || !is_value(cells_[0], separator_);
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
    const bool is_title = header_.size() == 1 || separator_of(header_text_) == ' ' ||
                          2 * header_.size() < cells_.size();
    if (!header_.empty() && header_.size() != cells_.size()) {
      if (!is_title) {
        throw Error(reader_.place(), fmt::format("has {} numbers", cells_.size()),
                    fmt::format("the line of names before it has {}", header_.size()));
      }
      add_words(std::exchange(header_text_, {}));
      header_.clear();
    }
    line_cells_ = cells_.size();
    if (header_.empty() && cells_.size() > 2 && count_columns(cells_)) {
      table_.notes.emplace_back(
          "The first line counts 0, 1, 2, ... and is read as readings. If it names columns, save "
          "the table without a header.");
    }
    columns_ = choose_columns(header_, cells_, separator_, options_, reader_.place());
    take_times();
    lines_.emplace(options_, header_, cells_.size(), columns_, reader_.place());
    long_columns_ = long_columns(header_, columns_, options_, reader_.place());
    for (const std::size_t column : columns_.readings) {
      if (column < header_.size()) table_.words.add_heading(header_[column]);
    }
    if (!columns_.left_out.empty()) {
      table_.notes.push_back(
          fmt::format("Columns that are no readings are left out: {}; --columns chooses others.",
                      fmt::join(columns_.left_out, ", ")));
    }
    table_.cells = columns_.readings.size();
    table_.time_unit_s = columns_.time_unit_s;
    if (long_columns_) return;
    if (held_) take_held();
    if (!table_.size && options_.axes.empty()) table_.size = columns_.size;
    table_.notes.insert(table_.notes.end(), columns_.notes.begin(), columns_.notes.end());
    const auto& size = table_.size;
    const std::size_t sensels = size ? std::size_t{size->rows} * size->cols : 0;
    if (!size || table_.cells == sensels || table_.cells == size->cols) return;
    const std::string needs = fmt::format("a frame of {} x {} needs {}, or rows of {}; ",
                                          size->rows, size->cols, sensels, size->cols);
    throw ProposingError(
        reader_.place(),
        fmt::format("has {} numbers, {} of them readings", line_cells_, table_.cells),
        needs + (line_cells_ > sensels ? "choose them with --columns, and a column of times with "
                                         "--times"
                                       : "give the --shape of one frame"),
        needs + "choose them with",
        proposals_by_cells(path_, separator_, line_cells_, sensels, options_));
  }

  /// Takes the column of times that the options name; an empty one is none.
  void take_times() {
    if (!options_.times.empty()) {
      std::size_t column = 0;
      const auto [end, error] = std::from_chars(
          options_.times.data(), options_.times.data() + options_.times.size(), column);
      const auto named = std::ranges::find(header_, options_.times);
      if (named != header_.end()) {
        column = static_cast<std::size_t>(named - header_.begin()) + 1;
      } else if (error != std::errc{} || *end != '\0' || column < 1 || column > line_cells_) {
        throw Error(reader_.place(),
                    fmt::format("has {} columns and none for --times '{:.60}'", line_cells_,
                                options_.times),
                    fmt::format("give its name or number, from 1 to {}", line_cells_));
      }
      columns_.time = column - 1;
      std::erase(columns_.readings, column - 1);
      const auto words = words_in(named == header_.end() ? "" : *named);
      columns_.time_unit_s =
          words.empty() ? 0 : unit_size(Dimension::time, words.back()).value_or(0);
      if (parse_time(cells_[column - 1])) columns_.time_unit_s = 1;
    }
    if (!columns_.time || !cells_[*columns_.time].empty()) return;
    columns_.time.reset();
    table_.notes.emplace_back("The first time is empty, and the column of times is left out.");
  }

  void append() {
    if (std::exchange(cut_since_, false)) cut_between_ = cut_between_ || table_.lines > 0;
    if (std::exchange(words_since_, false)) table_.has_words_between |= table_.lines > 0;
    if (table_.readings.size() + table_.cells > kMostTableReadings) {
      throw Error(reader_.place(), fmt::format("follows {} readings", table_.readings.size()),
                  "tables of at most 134217728 readings are read; save it as .npy");
    }
    const double time = columns_.time ? time_in(*columns_.time) : 0;
    ++table_.lines;
    ++block_rows_;
    if (long_columns_) return append_long(time);
    if (columns_.time) table_.times.push_back(time);
    if (!columns_.time && stamp_s_) table_.times.push_back(rising_(*stamp_s_));
    for (const std::size_t column : columns_.readings)
      table_.readings.push_back(column == kNoColumn ? NAN : reading_in(column));
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
    entries_.push_back({frame, row, col, time, reading_in(columns.value)});
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

  /// The reading in a column, NaN if it is missing.
  [[nodiscard]] float reading_in(std::size_t column) const {
    const double number = number_in(column);
    if (!std::isfinite(number)) return std::numeric_limits<float>::quiet_NaN();
    if (std::abs(number) <= std::numeric_limits<float>::max()) return static_cast<float>(number);
    throw Error(reader_.place(),
                fmt::format("'{:.30}' in column {} is beyond float32", cells_[column], column + 1),
                "write a reading of at most 3.4e38, and nan for a missing one");
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
    blocks_.push_back(std::exchange(block_rows_, 0));
    block_ends_.push_back(reader_.number());
  }

  /// Leaves out blocks that are cut, and says what was left out.
  void finish() {
    if (!columns_.time && table_.times.size() == table_.lines) table_.time_unit_s = 1;
    if (!columns_.time && table_.times.size() != table_.lines) table_.times.clear();
    if (left_out_ > 0 && table_.lines > 0) {
      table_.notes.push_back(fmt::format("{} line{} of words or cut {} left out, first {}.",
                                         left_out_, left_out_ == 1 ? "" : "s",
                                         left_out_ == 1 ? "is" : "are", first_left_out_));
    }
    const auto& size = table_.size;
    const bool are_frames = long_columns_ || (size && table_.cells != size->cols) ||
                            (size && size->rows == 1) ||
                            (!size && blocks_.size() == 1 && !table_.times.empty());
    table_.has_words_between = table_.has_words_between && !are_frames;
    table_.blocks = blocks_.size();
    if (blocks_.empty() || are_frames) return;
    std::map<std::uint64_t, std::uint64_t> counts;
    std::uint64_t usual = blocks_[0];
    for (const std::uint64_t rows : blocks_) {
      if (++counts[rows] > counts[usual]) usual = rows;
    }
    table_.rows = usual;
    const std::uint64_t whole = counts[usual];
    if (whole < 2 || (size && size->rows != usual)) {
      if (cut_between_) {
        table_.refusal.emplace(cut_, fmt::format("has {} numbers", cut_cells_),
                               fmt::format("lines before it have {}", line_cells_));
      } else if (whole != blocks_.size() && !size) {
        const auto other = std::ranges::find_if(blocks_, [&](auto rows) { return rows != usual; });
        table_.refusal.emplace(
            fmt::format("{}:{}", reader_.path().string(),
                        block_ends_[static_cast<std::size_t>(other - blocks_.begin())]),
            fmt::format("a frame of {} rows ends here", *other),
            fmt::format("others have {}", usual));
      }
      return;
    }
    table_.has_words_between = false;
    if (whole == blocks_.size()) return;
    std::size_t from = 0;
    std::size_t to = 0;
    for (const std::uint64_t rows : blocks_) {
      for (std::uint64_t row = 0; row < rows; ++row, ++from) {
        if (rows != usual) continue;
        if (!table_.times.empty()) table_.times[to] = table_.times[from];
        std::copy_n(&table_.readings[from * table_.cells], table_.cells,
                    &table_.readings[to++ * table_.cells]);
      }
    }
    table_.readings.resize(to * table_.cells);
    if (!table_.times.empty()) table_.times.resize(to);
    table_.lines = to;
    table_.blocks = whole;
    table_.notes.push_back(
        fmt::format("{} of {} blocks have not the {} rows of the others and are left out.",
                    blocks_.size() - whole, blocks_.size(), usual));
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
  std::size_t length_ = 0;                 // usual number of cells in a line
  std::size_t line_cells_ = 0;             // of the first line
  std::uint64_t block_rows_ = 0;           // of the block so far
  std::vector<std::uint64_t> blocks_;      // rows of each
  std::vector<std::uint64_t> block_ends_;  // their lines
  std::optional<double> stamp_s_;          // of the line
  std::uint64_t left_out_ = 0;             // lines
  std::string first_left_out_;
  std::string cut_;  // place of the first line that is cut
  std::size_t cut_cells_ = 0;
  bool cut_since_ = false;    // after the last line of numbers
  bool words_since_ = false;  // the same
  bool cut_between_ = false;
  bool is_clock_ = false;
  bool is_ended_ = false;
  RisingClock rising_;
};

}  // namespace

Table parse_table(const std::filesystem::path& path, const ReadOptions& options,
                  std::uint64_t header_line) {
  return TableParser(path, options, header_line).parse();
}

}  // namespace pillarfield
