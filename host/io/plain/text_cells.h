#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pillarfield {

/// A text without the blanks around it.
[[nodiscard]] std::string_view without_blanks(std::string_view text,
                                              std::string_view blanks = " \t\f");

/// The separator of a line's cells: ';', tab, ',' or ' ' for any number of blanks.
[[nodiscard]] char separator_of(std::string_view line);

/// Splits a line into cells without blanks and quotes around them. Between blanks, a date and the
/// time after it are one cell, and so are a time and AM or PM.
void split_cells(std::string_view line, char separator, std::vector<std::string>& cells);

/// Removes empty cells at the end, such as spreadsheets write, down to `least` cells.
void drop_empty_end(std::vector<std::string>& cells, std::size_t least = 0);

/// Reads a number; an empty cell, "NA", "null", "None" and their like are a missing reading, NaN.
/// Unless it separates cells, a comma is a decimal mark.
[[nodiscard]] bool read_cell(std::string_view cell, char separator, double& value);

/// True if a cell is a number, a time or missing.
[[nodiscard]] bool is_value(std::string_view cell, char separator);

/// A date and time of ISO 8601, "2024-05-01 12:00:00.015", in seconds since 1970, UTC. The blank
/// may be a T, and Z or an offset such as +02:00 may follow; without them it is taken as UTC.
[[nodiscard]] std::optional<double> parse_iso_time(std::string_view text);

/// A time of day, "08:21:17.982" or "8:21:17.982 PM", in seconds since midnight, or a
/// parse_iso_time().
[[nodiscard]] std::optional<double> parse_time(std::string_view text);

/// Takes the stamp of a serial monitor off a line, "08:21:17.982 -> " or "[08:21:17] ", s.
[[nodiscard]] std::optional<double> take_stamp(std::string_view& line);

/// True if a line is a comment, behind '#', '%' or '//', or Excel's word on the separator.
[[nodiscard]] bool is_comment(std::string_view line);

/// True if a line has no cells: blanks and separators, or a row of dashes or their like.
[[nodiscard]] bool is_blank_or_rule(std::string_view line);

/// Times of day that pass midnight go on rising: adds a day to each that falls by half a day.
class RisingClock {
 public:
  double operator()(double time_s);

 private:
  double before_s_ = 0;
  double days_s_ = 0;
};

/// The words of a name, lower case: "Sensel Width (cm)", "timeStamp_ms" and "f3x" have "sensel",
/// "width", "cm", "time", "stamp", "ms", "f" and "x".
[[nodiscard]] std::vector<std::string> words_in(std::string_view name);

[[nodiscard]] std::string lower_case(std::string_view text);

}  // namespace pillarfield
