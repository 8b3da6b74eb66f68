#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pillarfield {

/// A date and time of ISO 8601, "2024-05-01 12:00:00.015", in seconds since 1970, UTC. The blank
/// may be a T, and Z or an offset such as +02:00 may follow; without them it is taken as UTC.
[[nodiscard]] std::optional<double> parse_iso_time(std::string_view text);

/// The columns of a table before its readings: row numbers, times, or both.
struct LeadingColumns {
  std::size_t count = 0;
  std::optional<std::size_t> time;
  bool is_iso = false;
  double unit_s = 0;  ///< of a time that is a number; 0 if the name of the column states none
};

/// Whether the cells of the first line name columns: without a number among them, or with column
/// numbers after the name of a leading column or after an empty cell, as pandas writes them.
[[nodiscard]] bool is_header(std::span<const std::string> cells);

/// The leading columns by their names, if there is a header, and the first line below it: a column
/// `index` or `frame`, or an unnamed one of whole numbers; one named `time`, `timestamp`,
/// `datetime` or `t`, also as `time_ms` or `time (s)`, or of ISO times.
[[nodiscard]] LeadingColumns find_leading_columns(std::span<const std::string> header,
                                                  std::span<const std::string> first);

/// The unit of times whose column states none: seconds, or where these would lie beyond the year
/// 5000, milli-, micro- or nanoseconds since 1970.
[[nodiscard]] double likely_unit_s(double time);

/// Reads a number; an empty cell is a missing reading, NaN.
[[nodiscard]] bool read_cell(std::string_view cell, double& value);

}  // namespace pillarfield
