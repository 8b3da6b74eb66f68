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
  std::optional<double> newtons_per_unit;  ///< of a cell in a unit of force
  std::optional<double> mpa_per_unit;      ///< of a cell in a unit of pressure
  std::optional<double> sensel_area_mm2;

  /// Parses a line "KEY value"; ignores unknown keys. Throws Error, naming `place`, if the value is
  /// invalid.
  void parse_line(std::string_view line, const std::string& place);

  /// Whether cells are forces or pressures instead of raw counts.
  [[nodiscard]] bool is_calibrated() const { return newtons_per_unit || mpa_per_unit; }

  /// Area of a sensel: SENSEL_AREA, else the product of the spacings; unset if neither is given.
  [[nodiscard]] std::optional<double> area_mm2() const;

  /// Force on a sensel whose cell is 1; unset for raw counts and for pressures without an area.
  [[nodiscard]] std::optional<double> newtons_per_cell() const;
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
