// Frames in a text as blocks of rows between lines of words, as exports of pressure plates, seats
// and insoles are. No rule is of one vendor: the words give sizes, units, numbers and times of the
// frames, and the sums, forces and largest values that the cells must agree with.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "io/frame_source.h"
#include "io/plain/source.h"
#include "io/plain/stated_words.h"
#include "io/plain/table_columns.h"
#include "io/plain/table_source.h"
#include "io/plain/text_cells.h"
#include "io/tekscan/line_reader.h"
#include "io/units.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostCells = std::size_t{1} << 26U;

/// A sum, force or largest value that the file states, and that of its cells.
struct Check {
  std::string name;
  bool is_force = false;
  double stated = 0;  ///< N if it is a force
  double rounding = 0;
  double of_cells = 0;
  std::uint64_t line = 0;
};

/// The rows and columns of a frame, or of a part of it.
struct CellBlock {
  std::string name;         ///< the last words with a text before it
  std::size_t ordinal = 0;  ///< in its frame
  std::uint64_t line = 0;
  std::optional<double> number;  ///< of the frame
  std::optional<double> time_s;
  std::optional<double> stamp_s;          ///< of the serial monitor, at its first row
  std::set<std::string> before;           ///< words before it, without numbers
  std::vector<Statement> stated;          ///< checks of the whole
  std::vector<std::string> labels;        ///< cells of the words before its rows
  std::vector<std::vector<double>> rows;  ///< as read: with labels, NaN for words, and sums
  std::vector<std::string> names;         ///< words that begin the rows
  bool is_labelled = false;
  std::size_t cols = 0;
  std::vector<float> cells;  ///< row by row
  std::vector<Check> checks;

  [[nodiscard]] std::string size() const {
    return fmt::format("{} x {}", cells.size() / std::max<std::size_t>(1, cols), cols);
  }
};

bool is_largest(const Statement& stated) {
  return stated.has_any({"max", "maximum", "peak"}) &&
         stated.has_only({"max", "maximum", "peak", "pressure", "value", "reading"});
}

bool is_force(const Statement& stated) { return stated.has_any({"force", "load"}); }

bool is_sum(const Statement& stated) {
  return stated.has_any({"force", "load", "sum"}) &&
         stated.has_only({"force", "load", "sum", "total", "est", "estimated", "raw", "pressure"});
}

/// Sum and largest value of some cells.
struct CellTotals {
  double sum = 0;
  double largest = 0;

  void add(float cell) {
    if (!std::isfinite(cell)) return;
    sum += cell;
    largest = std::max<double>(largest, cell);
  }
};

/// Adds what is stated about some cells, if it is a sum or a largest value.
void add_check(CellBlock& block, const Statement& stated, const CellTotals& totals) {
  if (!is_sum(stated) && !is_largest(stated)) return;
  Check check{fmt::format("{}", fmt::join(stated.words, " ")),
              is_force(stated),
              stated.value,
              stated.rounding,
              is_largest(stated) ? totals.largest : totals.sum,
              stated.line};
  if (check.is_force) check.stated *= unit_size(Dimension::force, stated.unit).value_or(1);
  block.checks.push_back(std::move(check));
}

bool is_number(const std::string& cell) {
  double value = 0;
  return !cell.empty() && read_cell(cell, ' ', value);
}

/// True if numbers count up by one.
bool count_up(const std::vector<double>& numbers) {
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    if (numbers[i] != numbers[0] + static_cast<double>(i)) return false;
  }
  return numbers.size() > 2 && numbers[0] == std::floor(numbers[0]);
}

class SectionParser {
 public:
  SectionParser(const std::filesystem::path& path, const std::optional<FrameSize>& size)
      : reader_(path, "save its frames as .npy"),
        frame_cells_(size ? std::size_t{size->rows} * size->cols : 0) {}

  /// Reads all blocks, or of a table, whose lines have a time, the line of names alone.
  void parse() {
    while (!table_line && reader_.next()) {
      std::string_view line = reader_.line();
      if (line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
      stamp_s_ = take_stamp(line);
      const char separator = separator_of(line);
      split_cells(line, separator, cells_);
      drop_empty_end(cells_);
      const bool is_number_of_frame = cells_.size() == 2 && !is_number(cells_[0]) &&
                                      std::ranges::any_of(statements_in(line, 0), is_frame_number);
      if (!cells_.empty() && (is_number_of_frame || !add_row(separator))) add_words(line);
    }
    end_block();
    // Sums that follow the cells came with the words of the next block.
    if (!blocks.empty() && blocks[0].stated.empty()) {
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        blocks[i].stated = std::move(i + 1 < blocks.size() ? blocks[i + 1] : open_).stated;
      }
    }
    join_blocks();
    for (CellBlock& block : blocks) {
      CellTotals totals;
      for (const float cell : block.cells) totals.add(cell);
      for (const Statement& stated : block.stated) add_check(block, stated, totals);
    }
    are_lines_frames_ = frame_cells_ > 0 && std::ranges::any_of(blocks, [&](const auto& block) {
                          return block.cols == frame_cells_ && block.cells.size() > frame_cells_;
                        });
    if (!number_) sort_by_size();
  }

  /// True if the blocks are frames, and the lines between them no mere comments: two have one size,
  /// or the one has row numbers or sums.
  [[nodiscard]] bool has_frames(const ReadOptions& options) const {
    if (!options.columns.empty() || !options.axes.empty() || !options.times.empty()) return false;
    const auto [usual, count] = usual_block();
    if (usual == nullptr || are_lines_frames_) return false;
    const auto& size = options.frame_size;
    if (size && usual->cells.size() != std::size_t{size->rows} * size->cols) return false;
    return number_ || (blocks.size() == 1 && (usual->is_labelled || !usual->checks.empty())) ||
           (count > 1 && (size || 4 * count >= blocks.size()));
  }

  std::optional<std::uint64_t> table_line;
  StatedWords words;
  std::vector<CellBlock> blocks;
  std::size_t left_out = 0;  // blocks of other sizes

 private:
  /// The first block of the usual size, or of the one that is given, and how many have it.
  [[nodiscard]] std::pair<const CellBlock*, std::size_t> usual_block() const {
    std::map<std::string, std::pair<const CellBlock*, std::size_t>> sizes;
    for (const CellBlock& block : blocks) {
      auto& [first, count] = sizes.try_emplace(block.size(), &block, 0).first->second;
      ++count;
    }
    std::pair<const CellBlock*, std::size_t> usual = {nullptr, 0};
    for (const auto& [name, size] : sizes) {
      const auto fits = [&](const CellBlock* block) {
        return block != nullptr && block->cells.size() == frame_cells_;
      };
      const bool is_earlier = size.second == usual.second && size.first < usual.first;
      if (fits(size.first) != fits(usual.first) ? fits(size.first)
                                                : size.second > usual.second || is_earlier)
        usual = size;
    }
    return usual;
  }

  /// Joins two blocks that words other than those between frames cut from one.
  void join_blocks() {
    const std::pair usual_block_and_count = usual_block();
    const CellBlock* const usual_one = usual_block_and_count.first;
    const std::size_t count = usual_block_and_count.second;
    const std::string usual = usual_one == nullptr ? "" : usual_one->size();
    std::map<std::string, std::size_t> kinds;  // of lines before whole frames
    for (const CellBlock& block : blocks) {
      if (block.size() != usual) continue;
      for (const std::string& kind : block.before) ++kinds[kind];
    }
    const auto is_between_frames = [&](const std::string& kind) { return 2 * kinds[kind] > count; };
    std::vector<CellBlock> joined;
    for (CellBlock& block : blocks) {
      CellBlock* const last = joined.empty() ? nullptr : &joined.back();
      const bool is_part = last != nullptr && last->size() != usual && block.size() != usual &&
                           last->cols == block.cols && last->number == block.number &&
                           !last->is_labelled && !block.is_labelled && last->checks.empty() &&
                           block.checks.empty() &&
                           std::ranges::none_of(block.before, is_between_frames);
      if (!is_part) {
        joined.push_back(std::move(block));
        continue;
      }
      last->cells.insert(last->cells.end(), block.cells.begin(), block.cells.end());
      std::ranges::move(block.stated, std::back_inserter(last->stated));
    }
    blocks = std::move(joined);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const bool goes_on = i > 0 && blocks[i].number == blocks[i - 1].number;
      blocks[i].ordinal = goes_on ? blocks[i - 1].ordinal + 1 : 0;
    }
  }

  /// Numbers the sizes of blocks that have no numbers of frames, as parts of frames; rare sizes are
  /// frames that are cut.
  void sort_by_size() {
    const auto [usual, most] = usual_block();
    if (usual == nullptr) return;
    const std::size_t cells = usual->cells.size();
    std::map<std::string, std::size_t> counts;
    std::map<std::string, std::size_t> ordinals = {{usual->size(), 0}};
    for (const CellBlock& block : blocks) ++counts[block.size()];
    left_out = std::erase_if(blocks, [&, most = most](const CellBlock& block) {
      return cells == frame_cells_ ? block.cells.size() != cells : 2 * counts[block.size()] < most;
    });
    for (CellBlock& block : blocks)
      block.ordinal = ordinals.try_emplace(block.size(), ordinals.size()).first->second;
  }

  /// Adds the cells as a row if they are numbers, the first one also a word.
  bool add_row(char separator) {
    std::vector<double> row(cells_.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (!read_cell(cells_[i], separator, row[i]) && i > 0) return false;
    }
    const auto are_finite = [](double value) { return std::isfinite(value); };
    const bool fits = !open_.rows.empty() && open_.rows.back().size() == row.size();
    const std::vector<std::string>& labels = open_.labels;
    const bool is_named = labels.size() == row.size() && row.size() > 2 && !has_digit(labels[0]) &&
                          is_number(labels[1]) && is_number(labels[2]);
    const bool is_word = !is_number(cells_[0]) && !cells_[0].empty();
    if ((is_word && !fits && !is_named) || (!fits && std::ranges::count_if(row, are_finite) < 2))
      return false;
    if (!number_ && blocks.empty() && open_.rows.empty() && labels.size() == row.size() &&
        std::ranges::any_of(labels, names_time)) {
      table_line = labels_line_;
      return true;
    }
    const bool counts_columns =
        open_.rows.size() == 1 && count_up(open_.rows[0]) && row.size() == open_.rows[0].size() + 1;
    const bool follows_sums =
        fits && !is_word && open_.names[0].empty() && !open_.names.back().empty();
    if ((!fits && !counts_columns) || follows_sums) end_block();
    if (open_.rows.empty()) {
      open_.line = reader_.number();
      open_.stamp_s = stamp_s_;
    }
    cells_read_ += row.size();
    if (cells_read_ > kMostCells) {
      throw Error(reader_.place(), "follows 67108864 numbers, the most that are read of a text",
                  "save its frames as .npy");
    }
    open_.rows.push_back(std::move(row));
    open_.names.push_back(is_word ? cells_[0] : "");
    return true;
  }

  void add_words(std::string_view line) {
    end_block();
    std::vector<Statement> statements = statements_in(line, reader_.number());
    words.add(line, statements);
    bool begins_frame = false;
    for (Statement& stated : statements) {
      if (is_frame_number(stated)) {
        begins_frame = true;
        begin_frame(stated.value);
      }
      if (!time_s_) time_s_ = time_in(stated, begins_frame);
      if (is_sum(stated) || is_largest(stated)) open_.stated.push_back(std::move(stated));
    }
    open_.labels = begins_frame ? std::vector<std::string>() : cells_;
    std::string kind(line);
    std::erase_if(kind, [](char letter) { return has_digit({&letter, 1}); });
    open_.before.insert(std::move(kind));
    labels_line_ = reader_.number();
    const bool is_text =
        cells_.size() > 1 && !cells_[1].empty() && !has_digit(cells_[1].substr(0, 1));
    if (!begins_frame && is_text) open_.name = fmt::format("{} {}", cells_[0], cells_[1]);
  }

  static bool is_frame_number(const Statement& stated) {
    return stated.has_any({"frame", "pict", "picture", "image", "sample", "scan"}) &&
           stated.has_only(
               {"frame", "pict", "picture", "image", "sample", "scan", "no", "nr", "number"}) &&
           stated.value == std::floor(stated.value) && stated.unit.empty();
  }

  /// The time of a frame, s, if a statement is one; `begins_frame`: it is in the line of its
  /// number.
  static std::optional<double> time_in(const Statement& stated, bool begins_frame) {
    const auto unit_s = stated.is_clock ? 1.0 : unit_size(Dimension::time, stated.unit);
    const bool is_time = stated.has_only({"time", "timestamp", "t", "frame", "at"}) ||
                         (stated.words.empty() && begins_frame && unit_s);
    if (!is_time || (begins_frame && !unit_s)) return std::nullopt;
    return stated.value * unit_s.value_or(1);
  }

  void begin_frame(double number) {
    number_ = number;
    time_s_.reset();
    open_.name.clear();
    if (blocks.empty() || !blocks[0].stated.empty()) open_.stated.clear();
  }

  void end_block() {
    if (open_.rows.empty()) return;
    CellBlock block = std::exchange(open_, {});
    block.number = number_;
    block.time_s = block.stamp_s ? block.stamp_s : time_s_;
    take_cells(block);
    blocks.push_back(std::move(block));
  }

  /// A reading that is finite or missing.
  [[nodiscard]] float reading_of(double number, std::uint64_t line) const {
    if (!std::isfinite(number)) return std::numeric_limits<float>::quiet_NaN();
    if (std::abs(number) <= std::numeric_limits<float>::max()) return static_cast<float>(number);
    throw Error(fmt::format("{}:{}", reader_.path().string(), line),
                fmt::format("{:g} is beyond float32", number),
                "write readings of at most 3.4e38, and nan for a missing one");
  }

  /// Takes labels and sums off the rows.
  void take_cells(CellBlock& block) {
    std::vector<std::vector<double>> rows = std::exchange(block.rows, {});
    if (rows.size() > 1 && rows[1].size() > rows[0].size()) {  // Column numbers.
      rows.erase(rows.begin());
      block.names.erase(block.names.begin());
      block.is_labelled = true;
      ++block.line;
    }
    const std::size_t width = rows[0].size();
    std::size_t cols_end = width;
    std::size_t rows_end = rows.size();
    const auto numbers = static_cast<std::size_t>(std::ranges::count_if(block.labels, is_number));
    if (block.labels.size() == width && 2 * numbers >= width) {
      while (!is_number(block.labels[cols_end - 1])) --cols_end;
      block.is_labelled = block.is_labelled || !is_number(block.labels[0]);
    }
    while (rows_end > 1 && block.names[0].empty() && !block.names[rows_end - 1].empty()) --rows_end;
    std::vector<double> first;
    for (std::size_t i = 0; i < rows_end; ++i) first.push_back(rows[i][0]);
    block.is_labelled = block.is_labelled || !block.names[0].empty() ||
                        (count_up(first) && words.cols.value_or(0) != static_cast<double>(width));
    const std::size_t begin = block.is_labelled ? 1 : 0;
    if (words.cols && cols_end == width && *words.cols + 1 == static_cast<double>(width - begin))
      --cols_end;
    block.cols = cols_end - begin;
    for (std::size_t i = 0; i < rows_end; ++i) {
      for (std::size_t j = begin; j < cols_end; ++j)
        block.cells.push_back(reading_of(rows[i][j], block.line + i));
    }
    add_checks(block, rows, {begin, cols_end, rows_end});
  }

  /// Cells in the rows of a block; behind them come sums.
  struct CellRange {
    std::size_t first_col;
    std::size_t cols_end;
    std::size_t rows_end;
  };

  /// Checks the sums behind the rows and below the columns.
  static void add_checks(CellBlock& block, const std::vector<std::vector<double>>& rows,
                         const CellRange& range) {
    const std::size_t width = rows[0].size();
    std::vector<CellTotals> of_rows(range.rows_end);
    std::vector<CellTotals> of_cols(block.cols);
    CellTotals of_all;
    for (std::size_t i = 0; i < block.cells.size(); ++i) {
      for (CellTotals* const each : {&of_rows[i / block.cols], &of_cols[i % block.cols], &of_all})
        each->add(block.cells[i]);
    }
    const auto add = [&](const std::string& name, std::size_t row, std::size_t col,
                         const CellTotals& totals) {
      const double value = rows[row][col];
      const Statement stated{
          words_in(name.empty() ? "sum" : name), value, 0.005, {}, false, block.line + row};
      if (std::isfinite(value)) add_check(block, stated, totals);
    };
    for (std::size_t j = range.cols_end; j < width; ++j) {
      const std::string name = block.labels.size() == width ? block.labels[j] : "";
      for (std::size_t i = 0; i < range.rows_end; ++i) add(name, i, j, of_rows[i]);
    }
    for (std::size_t i = range.rows_end; i < rows.size(); ++i) {
      for (std::size_t j = range.first_col; j < range.cols_end; ++j)
        add(block.names[i], i, j, of_cols[j - range.first_col]);
      if (range.cols_end < width) add(block.names[i], i, range.cols_end, of_all);
    }
  }

  LineReader reader_;
  std::size_t frame_cells_;  // 0: not known
  bool are_lines_frames_ = false;
  std::vector<std::string> cells_;
  CellBlock open_;
  std::uint64_t labels_line_ = 0;
  std::size_t cells_read_ = 0;
  std::optional<double> number_;
  std::optional<double> time_s_;
  std::optional<double> stamp_s_;
};

/// The blocks of one part of the frames, one in each, all of one size.
std::vector<const CellBlock*> frames_of(const SectionParser& parser, const std::string& part,
                                        const std::string& path, std::vector<std::string>& notes) {
  std::map<std::size_t, std::string> parts;
  for (const CellBlock& block : parser.blocks) {
    parts.try_emplace(block.ordinal,
                      fmt::format("{} '{}' of {}", block.ordinal + 1, block.name, block.size()));
  }
  std::vector<std::string> list;
  std::optional<std::size_t> chosen;
  for (const auto& [ordinal, name] : parts) {
    list.push_back(name);
    const bool fits = part.empty()      ? ordinal == 0
                      : is_number(part) ? name.starts_with(part + " ")
                                        : name.find(part) != std::string::npos;
    if (fits && !chosen) chosen = ordinal;
  }
  if (!chosen) {
    throw Error(path, fmt::format("has no part '{:.60}'", part),
                fmt::format("it has {}", fmt::join(list, ", ")));
  }
  if (part.empty() && list.size() > 1) {
    const std::size_t parts_found = list.size();
    list.resize(std::min<std::size_t>(list.size(), 3));
    notes.push_back(fmt::format(
        "Frames have {} parts, {}{}; the first is read, others with --dataset NUMBER or NAME.",
        parts_found, fmt::join(list, ", "), parts_found > list.size() ? ", ..." : ""));
  }
  std::vector<const CellBlock*> frames;
  for (const CellBlock& block : parser.blocks) {
    if (block.ordinal == *chosen) frames.push_back(&block);
  }
  std::map<std::string, std::size_t> sizes;
  std::string usual = frames[0]->size();
  for (const CellBlock* const frame : frames) {
    if (++sizes[frame->size()] > sizes[usual]) usual = frame->size();
  }
  std::size_t left_out = parser.left_out;
  if (sizes[usual] > 1 && 2 * sizes[usual] > frames.size()) {
    left_out += std::erase_if(frames, [&](const CellBlock* frame) {
      return !frame->is_labelled && frame->size() != usual;
    });
  }
  for (const CellBlock* const frame : frames) {
    if (frame->size() == frames[0]->size()) continue;
    throw Error(fmt::format("{}:{}", path, frame->line),
                fmt::format("a frame of {} begins here", frame->size()),
                fmt::format("frames before it have {}", frames[0]->size()));
  }
  if (left_out > 0) {
    notes.push_back(fmt::format(
        "{} {} of other sizes than {}, as frames that are cut, {} left out.", left_out,
        left_out == 1 ? "block" : "blocks", frames[0]->size(), left_out == 1 ? "is" : "are"));
  }
  const auto& [rows, cols] = std::pair(parser.words.rows, parser.words.cols);
  const std::string stated = fmt::format("{} x {}", rows.value_or(0), cols.value_or(0));
  if (rows && cols && *chosen == 0 && !frames[0]->is_labelled && frames[0]->size() != stated) {
    throw Error(fmt::format("{}:{}", path, frames[0]->line),
                fmt::format("a frame of {} begins here, and words before it state {}",
                            frames[0]->size(), stated),
                "export it again, with all rows");
  }
  return frames;
}

/// Compares the cells with what the file states of them. Returns the newtons of a cell of 1, if it
/// states forces; throws Error at the first contradiction.
std::optional<double> check_frames(const std::vector<const CellBlock*>& frames,
                                   std::vector<std::string>& notes, const std::string& path) {
  std::map<std::string, std::vector<const Check*>> kinds;
  for (const CellBlock* const block : frames) {
    for (const Check& check : block->checks) kinds[check.name].push_back(&check);
  }
  std::optional<double> newtons;
  std::vector<std::string> agreed;
  for (const auto& [name, checks] : kinds) {
    std::vector<double> ratios;
    for (const Check* const check : checks) {
      if (check->is_force && check->of_cells > 0) ratios.push_back(check->stated / check->of_cells);
    }
    std::ranges::sort(ratios);
    const double factor = ratios.empty() ? 1 : ratios[ratios.size() / 2];
    if (!ratios.empty()) newtons = factor;
    for (const Check* const check : checks) {
      constexpr double kRounded = 1e-3;
      const double expected = factor * check->of_cells;
      if (std::abs(check->stated - expected) <= 1.1 * check->rounding + kRounded * expected)
        continue;
      throw Error(fmt::format("{}:{}", path, check->line),
                  fmt::format("states a {} of {:.6g}, and its cells give {:.6g}", name,
                              check->stated, expected),
                  "the file was altered, or its cells are no readings; export it again");
    }
    agreed.push_back(fmt::format("{} of '{}'", checks.size(), name));
  }
  notes.push_back(agreed.empty() ? "The file states no sums to check its cells by."
                                 : fmt::format("Cells agree with what the file states: {}.",
                                               fmt::join(agreed, ", ")));
  return newtons;
}

std::vector<double> frame_times(const std::vector<const CellBlock*>& frames,
                                const std::optional<double>& period_s) {
  const bool is_timed =
      std::ranges::all_of(frames, [](const CellBlock* block) { return block->time_s.has_value(); });
  std::vector<double> times_s;
  RisingClock clock;
  for (std::size_t i = 0; i < frames.size() && (is_timed || period_s); ++i) {
    const double number = frames[i]->number && frames[0]->number
                              ? *frames[i]->number - *frames[0]->number
                              : static_cast<double>(i);
    times_s.push_back(is_timed ? clock(*frames[i]->time_s) : number * *period_s);
  }
  return times_s;
}

std::unique_ptr<FileSource> source_of(const SectionParser& parser,
                                      const std::filesystem::path& path,
                                      const ReadOptions& options) {
  std::vector<std::string> notes;
  const auto frames = frames_of(parser, options.dataset, path.string(), notes);
  ReadOptions known = options;
  known.axes = {ArrayAxis::frames, ArrayAxis::rows, ArrayAxis::columns};
  const std::size_t cells = frames[0]->cells.size();
  if (frames[0]->cols == cells && cells > 1 && !known.frame_size) {
    throw Error(path.string(), fmt::format("has one line of {} readings in each frame", cells),
                fmt::format("give the size of a frame, --shape ROWSxCOLS, or 1x{}", cells));
  }
  const auto by_forces = check_frames(frames, notes, path.string());
  const auto newtons = parser.words.newtons_per_cell(by_forces, known, notes, path.string());
  known.readings.clear();
  std::vector<float> readings;
  for (const CellBlock* const block : frames) {
    for (const float cell : block->cells) {
      readings.push_back(newtons ? static_cast<float>(cell * *newtons) : cell);
    }
  }
  const std::size_t cols = known.frame_size ? known.frame_size->cols : frames[0]->cols;
  auto source = array_source(path, "text of frames",
                             array_of(readings, {frames.size(), cells / cols, cols}, path.string()),
                             frame_times(frames, parser.words.period_s), known);
  source->warn(fmt::format("Each block between lines of words is a frame of {}{}.",
                           frames[0]->size(),
                           frames[0]->is_labelled ? ", behind its row numbers" : ""));
  for (std::string& note : notes) source->warn(std::move(note));
  return source;
}

std::unique_ptr<FileSource> open_sections(const std::filesystem::path& path,
                                          const ReadOptions& options) {
  SectionParser parser(path, options.frame_size);
  parser.parse();
  if (!parser.table_line && parser.has_frames(options)) return source_of(parser, path, options);
  return open_table_after(path, options, parser.table_line.value_or(0));
}

/// True if a text has a line of words first and then one of numbers, or states a unit of pressure.
bool looks_like_sections(std::string_view head) {
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  const auto is_text = [](char letter) {
    return static_cast<unsigned char>(letter) >= ' ' ||
           std::string_view("\t\n\r\f").find(letter) != std::string_view::npos;
  };
  if (head.empty() || head.find_first_of("{[<") == 0 || !std::ranges::all_of(head, is_text))
    return false;
  StatedWords words;
  std::vector<std::string> cells;
  for (std::size_t number = 1; !head.empty(); ++number) {
    std::string_view line = head.substr(0, head.find('\n'));
    head.remove_prefix(std::min(line.size() + 1, head.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    (void)take_stamp(line);
    if (line.starts_with('[')) return false;  // of a scene
    words.add(line, statements_in(line, number));
    split_cells(line, separator_of(line), cells);
    drop_empty_end(cells);
    if (number > 1 && cells.size() > 1 && std::ranges::all_of(cells, is_number)) return true;
  }
  return words.unit.rank > 0;
}

}  // namespace

std::unique_ptr<FileSource> open_frames_between_words(const std::filesystem::path& path,
                                                      const ReadOptions& options) {
  SectionParser parser(path, options.frame_size);
  parser.parse();
  if (parser.table_line || !parser.has_frames(options)) return nullptr;
  return source_of(parser, path, options);
}

SourceFormat sections_format() {
  return {.name = "text of frames between lines of words",
          .recognises = looks_like_sections,
          .open = open_sections};
}

}  // namespace pillarfield
