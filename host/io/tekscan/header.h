#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pillarfield {

/// Header of a Tekscan ASCII export: the lines before its first frame.
struct TekscanHeader {
  std::optional<std::uint32_t> rows;
  std::optional<std::uint32_t> cols;
  std::optional<double> row_spacing_mm;
  std::optional<double> col_spacing_mm;
  std::optional<double> noise_threshold_counts;
  std::optional<double> seconds_per_frame;
  std::optional<std::uint64_t> start_frame;
  std::optional<std::uint64_t> end_frame;
  bool units_given = false;

  /// Parses a line "KEY value"; ignores unknown keys. Throws Error, naming `place`, if the value is
  /// invalid or the unit is not raw.
  void parse_line(std::string_view line, const std::string& place);
};

/// Removes blanks at both ends of `text`.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Parses all of `text`, apart from blanks, as a number; unset if it is not one.
template <class Number>
[[nodiscard]] std::optional<Number> number_in(std::string_view text);

extern template std::optional<double> number_in<double>(std::string_view);
extern template std::optional<std::uint32_t> number_in<std::uint32_t>(std::string_view);
extern template std::optional<std::uint64_t> number_in<std::uint64_t>(std::string_view);

}  // namespace pillarfield
