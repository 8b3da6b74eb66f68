#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/read_options.h"

namespace pillarfield {

/// Columns of a table that are its readings and its times. Indices count from 0.
struct TableColumns {
  std::vector<std::size_t> readings;  ///< in their order in a frame; kNoColumn: none is there
  std::optional<std::size_t> time;
  double time_unit_s = 0;             ///< 0 if the name states none
  std::vector<std::string> left_out;  ///< names of columns that are no readings
  std::optional<FrameSize> size;      ///< of a frame in a line, if the names state it
  std::vector<std::string> notes;     ///< about order and size, sentences
  bool keeps_order = false;           ///< the options put the columns in an order of their own
};

/// Columns of a table with one reading a line.
struct LongColumns {
  std::size_t row = 0;
  std::size_t col = 0;
  std::size_t value = 0;
  std::optional<std::size_t> frame;
};

/// True if the cells of the first line name columns: without a number among them, or with numbers
/// after the name of a time or row number or after an empty cell, as pandas writes them.
[[nodiscard]] bool is_header(std::span<const std::string> cells, char separator);

/// Chooses the columns by `header`, empty if there is none, by the types of the cells `first` of
/// the first line below it, and by ReadOptions::columns.
///
/// A time has its name, as "time", "timestamp" or "epoch", also with a unit, or is a date or a time
/// of day. Row numbers, sums, labels, states and other measures are no readings unless the options
/// choose them. Numbers in names are the order of the readings, and rows and columns in them their
/// places. Throws Error, naming `place`, if the options choose nothing, if taxels have three
/// components, or if the names are of several kinds and nothing chooses among them.
[[nodiscard]] TableColumns choose_columns(std::span<const std::string> header,
                                          std::span<const std::string> first, char separator,
                                          const ReadOptions& options, const std::string& place);

[[nodiscard]] bool has_digit(std::string_view name);

/// True if cells are 0, 1, 2, ..., as programs name columns without a name.
[[nodiscard]] bool count_columns(std::span<const std::string> cells);

/// True if a column has the name of a time.
[[nodiscard]] bool names_time(std::string_view name);

/// The columns of a long table: one named row, one named column and one other reading; unset if
/// the table is none. Throws Error, naming `place`, if it has several readings.
[[nodiscard]] std::optional<LongColumns> long_columns(std::span<const std::string> header,
                                                      const TableColumns& columns,
                                                      const ReadOptions& options,
                                                      const std::string& place);

/// The unit of times whose column states none: seconds, or where these would lie beyond the year
/// 5000, milli-, micro- or nanoseconds since 1970.
[[nodiscard]] double likely_unit_s(double time);

}  // namespace pillarfield
