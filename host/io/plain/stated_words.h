#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/read_options.h"

namespace pillarfield {

/// A number that a line of words states: "Sensel Width (cm),0.86", "Time/picture:10.0 ms".
struct Statement {
  std::vector<std::string> words;  ///< before it, lower case
  double value = 0;
  double rounding = 0;    ///< half of its last digit
  std::string unit;       ///< empty if none is stated
  bool is_clock = false;  ///< a date or time of day, s
  std::uint64_t line = 0;

  [[nodiscard]] bool has_any(std::initializer_list<std::string_view> some) const;
  /// True if it has words, and no others.
  [[nodiscard]] bool has_only(std::initializer_list<std::string_view> some) const;
};

/// The numbers that line `number` states.
[[nodiscard]] std::vector<Statement> statements_in(std::string_view line, std::uint64_t number);

/// The unit of the cells, as some words name it.
struct CellUnit {
  std::string name = "counts";
  std::optional<double> mpa;      ///< of a cell of 1
  std::optional<double> newtons;  ///< of a cell of 1
  int rank = 0;                   ///< of the words: 3 if they are about the unit of all cells

  [[nodiscard]] bool is_same(const CellUnit& other) const;
};

/// The unit that ReadOptions::readings names. Throws Error if it is none.
[[nodiscard]] CellUnit unit_of_readings(std::string name);

/// The facts about all frames that a file states in words, whoever wrote it.
struct StatedWords {
  std::optional<double> rows;
  std::optional<double> cols;
  std::optional<double> period_s;
  std::optional<double> width_mm;  ///< of a sensel
  std::optional<double> height_mm;
  std::optional<double> area_mm2;
  CellUnit unit;

  void add(std::string_view line, const std::vector<Statement>& statements);
  /// Adds the name of a column of readings, such as "left pressure 1[N/cm²]" or "p3_kPa".
  void add_heading(std::string name);

  /// Newtons on a sensel whose cell is 1, and the constants of such readings in `options`; unset
  /// for counts. `by_forces`: that of the forces that the file states. ReadOptions::readings and
  /// the pitch of the options win, with a note. Throws Error if pressures have no area, if words
  /// about a size or a unit are not understood as a whole, or if forces contradict them.
  [[nodiscard]] std::optional<double> newtons_per_cell(std::optional<double> by_forces,
                                                       ReadOptions& options,
                                                       std::vector<std::string>& notes,
                                                       const std::string& place) const;

 private:
  void add_unit(std::string_view line);
  void add_unit(CellUnit unit);
  void add_number(const Statement& stated);
  void add_size(std::string_view line);
  [[nodiscard]] std::optional<Pitch> pitch() const;

  std::string unclear_size_;  // words about the size of a sensel
  std::string unclear_unit_;
  bool is_order_taken_ = false;  // of a width and a height
};

}  // namespace pillarfield
