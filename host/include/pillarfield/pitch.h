#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace pillarfield {

/// Distances between neighbouring sensels, or elements of a force field, mm. One number is both.
struct Pitch {
  double row_mm = 0;  ///< from one row to the next, along y
  double col_mm = 0;  ///< from one column to the next, along x

  constexpr Pitch() = default;
  constexpr Pitch(double both_mm)  // NOLINT(google-explicit-constructor): a number is a pitch.
      : row_mm(both_mm), col_mm(both_mm) {}
  constexpr Pitch(double from_row_to_row_mm, double from_column_to_column_mm)
      : row_mm(from_row_to_row_mm), col_mm(from_column_to_column_mm) {}

  [[nodiscard]] constexpr bool is_square() const { return row_mm == col_mm; }
  [[nodiscard]] constexpr double area_mm2() const { return row_mm * col_mm; }
  /// True if both are finite and above zero.
  [[nodiscard]] constexpr bool is_positive() const {
    return row_mm > 0 && col_mm > 0 && area_mm2() < std::numeric_limits<double>::infinity();
  }
  friend constexpr Pitch operator*(double factor, const Pitch& pitch) {
    return {factor * pitch.row_mm, factor * pitch.col_mm};
  }
  friend constexpr bool operator==(const Pitch&, const Pitch&) = default;
};

/// "5", or "7.62x5.08": from row to row, then from column to column.
[[nodiscard]] std::string text_of(const Pitch& pitch);

/// The pitch of such a text; empty for another one, or for a distance beyond 0.001 to 1000 mm.
[[nodiscard]] std::optional<Pitch> parse_pitch(std::string_view text);

/// True if both distances lie within 0.001 to 1000 mm.
[[nodiscard]] bool is_valid(const Pitch& pitch);

}  // namespace pillarfield
