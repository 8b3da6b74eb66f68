#include "io/tekscan/parser.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "io/tekscan/line_reader.h"
#include "pillarfield/calibration.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::uint32_t kLargestReading = 65535;

/// Largest cell of an export in units of force or pressure.
constexpr double kLargestCell = 1e6;

bool begins_frame(std::string_view line) { return line.starts_with("Frame"); }
bool ends_data(std::string_view line) { return line.starts_with("@@"); }

/// Removes the first cell from `rest` and returns it.
std::string_view take_cell(std::string_view& rest) {
  const std::size_t comma = rest.find(',');
  const std::string_view cell = trimmed(rest.substr(0, comma));
  rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  return cell;
}

/// The number in "Frame 7, 0.6"; unset if there is none.
std::optional<std::uint64_t> frame_number(std::string_view line) {
  return begins_frame(line) ? number_in<std::uint64_t>(take_cell(line).substr(std::strlen("Frame")))
                            : std::nullopt;
}

/// Fields of a line like "Frame 7, 0.6,, 12/2/2019 6:21:52PM,,,Raw Sum=,,310".
struct FrameLine {
  std::uint64_t number = 0;
  std::optional<double> time_s;
  std::optional<double> raw_sum;
};

std::optional<double> raw_sum_in(std::string_view line) {
  constexpr std::string_view kLabel = "Raw Sum";
  const std::size_t label = line.find(kLabel);
  if (label == std::string_view::npos) return std::nullopt;
  line.remove_prefix(label + kLabel.size());
  const std::size_t number = line.find_first_not_of("=, \t");
  if (number == std::string_view::npos) return std::nullopt;
  line.remove_prefix(number);
  return number_in<double>(take_cell(line));
}

class Parser {
 public:
  explicit Parser(const std::filesystem::path& path) : path_(path), lines_(path) {}

  TekscanExport parse();

 private:
  bool next_line();
  void read_header();
  void require_header();
  [[nodiscard]] FrameLine frame_line() const;
  void read_frame();
  void check_order(const FrameLine& frame) const;
  void next_row(const FrameLine& frame, std::uint32_t row);
  std::uint64_t read_row(std::uint32_t row);
  std::uint32_t read_cell(std::string_view cell);
  std::uint32_t read_counts(std::string_view cell);
  void read_newtons(std::string_view cell);
  [[noreturn]] void refuse_cell(std::string_view cell, std::string_view kind,
                                const std::string& mend) const;
  void mark(std::size_t sensel, bool is_present);

  std::filesystem::path path_;
  LineReader lines_;
  bool at_end_ = false;
  TekscanExport data_;
  std::uint32_t rows_ = 0;
  std::uint32_t cols_ = 0;
  std::uint32_t col_ = 0;                   // of the cell being read
  std::optional<double> newtons_per_cell_;  // unset: counts
};

/// Moves to the next line that is not blank.
bool Parser::next_line() {
  do {
    at_end_ = !lines_.next();
  } while (!at_end_ && trimmed(lines_.line()).empty());
  return !at_end_;
}

/// Reads up to the line of the first frame.
void Parser::read_header() {
  // "Frame rate 50" begins no frame.
  while (next_line() && !frame_number(lines_.line())) {
    data_.header.parse_line(lines_.line(), lines_.place());
  }
  if (at_end_) {
    throw Error(lines_.place(), "the export has no frame", "export it again, with the frames");
  }
}

void Parser::require_header() {
  const auto require = [&](const std::optional<std::uint32_t>& size, const char* key) {
    if (!size) {
      throw Error(lines_.place(), fmt::format("the header has no {}", key),
                  "export it again, with its header");
    }
    if (*size > kMaxSensels) {
      throw Error(path_.string(), fmt::format("{} is {}", key, *size),
                  fmt::format("at most {} are read", kMaxSensels));
    }
    return *size;
  };
  rows_ = require(data_.header.rows, "ROWS");
  cols_ = require(data_.header.cols, "COLS");
  newtons_per_cell_ = data_.header.newtons_per_cell();
  if (data_.header.is_calibrated() &&
      !(newtons_per_cell_.value_or(0) > 0 && *newtons_per_cell_ <= kLargestCell)) {
    throw Error(
        path_.string(),
        "the area of a sensel, which turns pressures into forces, is missing or out of range",
        "export it again, with SENSEL_AREA or the spacings in its header");
  }
}

FrameLine Parser::frame_line() const {
  std::string_view rest = lines_.line();
  FrameLine frame;
  frame.raw_sum = raw_sum_in(rest);
  const auto number = frame_number(rest);
  const std::string_view title = take_cell(rest);
  if (!number) {
    throw Error(lines_.place(), fmt::format("'{:.60}' has no frame number", title),
                "it must be like 'Frame 1'");
  }
  frame.number = *number;
  frame.time_s = number_in<double>(take_cell(rest));
  if (frame.time_s && !std::isfinite(*frame.time_s)) frame.time_s.reset();
  return frame;
}

void Parser::check_order(const FrameLine& frame) const {
  if (!data_.numbers.empty() && frame.number <= data_.numbers.back()) {
    throw Error(lines_.place(),
                fmt::format("frame {} comes after frame {}", frame.number, data_.numbers.back()),
                "one file must hold one export");
  }
  if (!data_.numbers.empty() && frame.time_s.has_value() == data_.times_s.empty()) {
    throw Error(lines_.place(), "some frames have a time and others do not",
                "export the whole movie at once");
  }
}

void Parser::read_frame() {
  const FrameLine frame = frame_line();
  const std::string place = lines_.place();
  check_order(frame);
  std::uint64_t sum = 0;
  for (std::uint32_t row = 0; row < rows_; ++row) {
    next_row(frame, row);
    sum += read_row(row);
  }
  if (frame.raw_sum && !newtons_per_cell_ && *frame.raw_sum != static_cast<double>(sum)) {
    throw Error(place,
                fmt::format("the readings of frame {} add up to {}, but its raw sum is {}",
                            frame.number, sum, *frame.raw_sum),
                "the file was altered; export it again");
  }
  data_.numbers.push_back(frame.number);
  if (frame.time_s) data_.times_s.push_back(*frame.time_s);
}

void Parser::next_row(const FrameLine& frame, std::uint32_t row) {
  if (next_line() && !begins_frame(lines_.line()) && !ends_data(lines_.line())) return;
  throw Error(lines_.place(),
              fmt::format("frame {} has only {} of {} rows", frame.number, row, rows_),
              "the export is truncated or its ROWS is wrong; export it again");
}

/// Parses a row of cells and returns the sum of its counts. Trailing commas are allowed.
std::uint64_t Parser::read_row(std::uint32_t row) {
  std::string_view rest = lines_.line();
  std::uint64_t sum = 0;
  for (col_ = 0; col_ < cols_; ++col_) {
    if (rest.empty()) {
      throw Error(lines_.place(), fmt::format("the row has only {} of {} columns", col_, cols_),
                  "the line is truncated or COLS is wrong; export it again");
    }
    const std::string_view cell = take_cell(rest);
    const bool is_present = cell != "B" && cell != "-1";
    mark(std::size_t{row} * cols_ + col_, is_present);
    sum += read_cell(is_present ? cell : "0");
  }
  if (rest.find_first_not_of(", \t") != std::string_view::npos) {
    throw Error(lines_.place(), fmt::format("the row has more than {} columns", cols_),
                "COLS is wrong; export it again");
  }
  return sum;
}

/// Appends the reading of a cell; returns its counts, zero for a calibrated one.
std::uint32_t Parser::read_cell(std::string_view cell) {
  if (!newtons_per_cell_) return read_counts(cell);
  read_newtons(cell);
  return 0;
}

std::uint32_t Parser::read_counts(std::string_view cell) {
  const auto counts = number_in<std::uint32_t>(cell);
  if (!counts || *counts > kLargestReading) {
    refuse_cell(cell, "raw reading",
                fmt::format("it must be a whole number in [0, {}], or B", kLargestReading));
  }
  data_.readings.append(static_cast<std::uint16_t>(*counts));
  return *counts;
}

void Parser::read_newtons(std::string_view cell) {
  const auto value = number_in<double>(cell);
  if (!value || !(*value >= 0 && *value <= kLargestCell)) {
    refuse_cell(cell, "calibrated reading",
                fmt::format("it must be a number in [0, {}], or B", kLargestCell));
  }
  data_.readings.append_force(static_cast<float>(*value * *newtons_per_cell_));
}

void Parser::refuse_cell(std::string_view cell, std::string_view kind,
                         const std::string& mend) const {
  throw Error(fmt::format("{}, column {}", lines_.place(), col_ + 1),
              cell.empty() ? "the cell is empty" : fmt::format("'{:.60}' is not a {}", cell, kind),
              mend);
}

/// The mask grows with the cells of the first frame, so that a header cannot cause a large
/// allocation.
void Parser::mark(std::size_t sensel, bool is_present) {
  if (data_.numbers.empty()) data_.mask.push_back(kGood);
  if (!is_present) data_.mask[sensel] = kAbsent;
}

TekscanExport Parser::parse() {
  read_header();
  require_header();
  do {
    if (!begins_frame(lines_.line())) {
      throw Error(lines_.place(), fmt::format("a frame has more than {} rows", rows_),
                  "ROWS is wrong; export it again");
    }
    read_frame();
  } while (next_line() && !ends_data(lines_.line()));
  return std::move(data_);
}

}  // namespace

SenselType CompactReadings::type() const {
  if (!newtons_.empty()) return SenselType::f32;
  return wide_.empty() ? SenselType::u8 : SenselType::u16;
}

void CompactReadings::append(std::uint16_t counts) {
  if (!wide_.empty()) {
    wide_.push_back(counts);
  } else if (counts <= 255) {
    narrow_.push_back(static_cast<std::uint8_t>(counts));
  } else {
    wide_.assign(narrow_.begin(), narrow_.end());
    wide_.push_back(counts);
    narrow_ = {};
  }
}

void CompactReadings::copy(std::size_t first, std::size_t count, void* out) const {
  if (!newtons_.empty()) {
    std::memcpy(out, newtons_.data() + first, count * sizeof(float));
  } else if (wide_.empty()) {
    std::memcpy(out, narrow_.data() + first, count);
  } else {
    std::memcpy(out, wide_.data() + first, count * sizeof(std::uint16_t));
  }
}

TekscanExport parse_tekscan(const std::filesystem::path& path) { return Parser(path).parse(); }

}  // namespace pillarfield
