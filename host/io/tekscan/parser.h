#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/skin.h"

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

  /// True if cells are forces or pressures instead of raw counts.
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

/// A sequence of readings: counts, stored in one byte each until one needs two, or newtons.
class CompactReadings {
 public:
  void append(std::uint16_t counts);
  void append_force(float newtons) { newtons_.push_back(newtons); }

  [[nodiscard]] SenselType type() const;

  /// The readings in newtons; empty if they are counts.
  [[nodiscard]] std::span<float> newtons() { return newtons_; }

  /// Copies `count` readings of type() from `first` on.
  void copy(std::size_t first, std::size_t count, void* out) const;

 private:
  std::vector<std::uint8_t> narrow_;
  std::vector<std::uint16_t> wide_;  // used instead of narrow_ unless empty
  std::vector<float> newtons_;
};

/// Content of a Tekscan ASCII export.
struct TekscanExport {
  TekscanHeader header;
  CompactReadings readings;            ///< frame by frame, row by row; 0: no sensel
  std::vector<std::uint64_t> numbers;  ///< of the frames, increasing
  std::vector<double> times_s;         ///< of the frames; empty if they have none
  std::vector<std::uint8_t> mask;      ///< [rows, cols]; kAbsent where any frame has no sensel
};

/// Reads an export. Throws Error with the line, and for a cell the column, of the first mistake.
/// Memory: one or two bytes per reading, four if calibrated.
[[nodiscard]] TekscanExport parse_tekscan(const std::filesystem::path& path);

}  // namespace pillarfield
