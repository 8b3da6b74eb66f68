#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/read_options.h"

namespace pillarfield {

/// A place of a frame for which the table has no column.
inline constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();

/// Columns whose names differ in numbers alone, in the order of these numbers.
struct ColumnFamily {
  std::string pattern;  ///< a name with '*' for the numbers that differ, "p*_kPa"
  std::vector<std::size_t> columns;
  std::vector<std::vector<std::uint64_t>> numbers;  ///< of each column, row before column
  bool states_places = false;                       ///< the numbers are those of row and column
};

/// The kinds of some columns, in the order in which they appear. A number that counts sensors, as
/// in "pad0_r1_c2", parts kinds.
[[nodiscard]] std::vector<ColumnFamily> kinds_of(std::span<const std::string> header,
                                                 std::span<const std::size_t> columns);

/// True if the kinds are rows of one array: alike in their numbers, and left and right, or
/// letters that follow each other.
[[nodiscard]] bool are_rows(const std::vector<ColumnFamily>& kinds);

/// Size of a frame that the numbers state; unset if they state none.
[[nodiscard]] std::optional<FrameSize> stated_size(const std::vector<ColumnFamily>& kinds);

/// The columns of the kinds in the order of a frame; with `size`, kNoColumn where none is.
[[nodiscard]] std::vector<std::size_t> in_order(const std::vector<ColumnFamily>& kinds,
                                                const std::optional<FrameSize>& size);

/// Kinds that are x, y and z components of the same taxels.
struct Components {
  ColumnFamily x;
  ColumnFamily y;
  ColumnFamily z;
  bool is_force = false;  ///< the names say so
};

/// The components among the kinds; kinds that belong to none go to `others`. Taxels whose names
/// differ in words are one.
[[nodiscard]] std::vector<Components> components_of(const std::vector<ColumnFamily>& kinds,
                                                    std::vector<ColumnFamily>& others);

/// True if the name has a word that readings have, such as force or channel.
[[nodiscard]] bool names_readings(const std::string& name);

/// The choice of just these columns for ReadOptions::columns: a pattern, or names, or numbers in
/// ranges.
[[nodiscard]] std::string choice_of(std::span<const std::string> header, const ColumnFamily& kind);

/// True if a name fits a pattern with '*' for any letters and '?' for one.
[[nodiscard]] bool fits_pattern(std::string_view name, std::string_view pattern);

}  // namespace pillarfield
