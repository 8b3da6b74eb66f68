#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pillarfield {

/// What the lines before the first frame of a Tekscan ASCII export say.
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

  /// Takes one line "KEY value"; keys without meaning here are passed over. Throws Error, its
  /// place being `place`, on a value that cannot be, and on units other than raw.
  void take(std::string_view line, const std::string& place);
};

/// `text` without blanks at either end.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// The whole of `text` as a number, blanks aside; unset where it is none.
template <class Number>
[[nodiscard]] std::optional<Number> number_in(std::string_view text);

extern template std::optional<double> number_in<double>(std::string_view);
extern template std::optional<std::uint32_t> number_in<std::uint32_t>(std::string_view);
extern template std::optional<std::uint64_t> number_in<std::uint64_t>(std::string_view);

}  // namespace pillarfield
