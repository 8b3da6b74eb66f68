#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/pressure_unit.h"

namespace pillarfield {

/// Meaning of a column's values.
enum class ColumnKind : std::uint8_t {
  count,     ///< a whole number
  identity,  ///< a whole number; 0: none
  number,    ///< NaN: unset
  word,      ///< index in a list of words
};

/// A column in what is shown while a sensor runs.
struct LiveColumn {
  const char* path = "";  ///< in the JSON of a frame: "force.normal"; empty: not there
  const char* head = "";  ///< of tables in viewer and browser: "normal"; empty: not there
  int rank = 0;           ///< place in these tables, 1 first
};

/// A column of a table of contacts, shared by files, streams, Python and viewer. Values are
/// doubles, which hold every possible count exactly.
template <class Row>
struct ContactColumn {
  const char* name = "";  ///< with its unit: "shear_x_n"
  const char* unit = "";  ///< "N", "mm", ...; empty for plain numbers
  const char* help = "";  ///< "force to the right"
  double (*get)(const Row&) = nullptr;
  void (*set)(Row&, double) = nullptr;    ///< accepts any number: the file may be damaged
  const char* (*word)(double) = nullptr;  ///< only for ColumnKind::word
  LiveColumn live = {};
  ColumnKind kind = ColumnKind::count;
  bool optional = false;    ///< absent from files of earlier versions
  bool of_pillars = false;  ///< does not exist without them
};

/// The columns id, parent, number, first_time_s, age_s.
[[nodiscard]] std::span<const ContactColumn<TrackedContact>> identity_columns();

using QuantityColumn = ContactColumn<ContactQuantities>;
using QuantityColumns = std::span<const QuantityColumn>;

/// One column for each quantity of a contact, the only list of them; those of its wrench come last,
/// and only `with_wrench`. Without pillars, those that do not exist are left out, and sensels are
/// counted.
[[nodiscard]] QuantityColumns quantity_columns(bool with_wrench = false,
                                               SkinLayout layout = SkinLayout::pillars);
/// Those of contacts found with these options.
[[nodiscard]] QuantityColumns quantity_columns(const ContactOptions& options);

/// The quantity of this name. Throws std::out_of_range without one.
[[nodiscard]] const QuantityColumn& quantity_column(std::string_view name);

/// The quantities with a head in live tables, in the order of their ranks.
[[nodiscard]] QuantityColumns live_columns(SkinLayout layout);

/// The columns id, merged_into, first_time_s, last_time_s.
[[nodiscard]] std::span<const ContactColumn<EndedContact>> ended_columns();

/// The name of a column whose pressures are in `unit`: "mean_pressure_psi".
template <class Row>
[[nodiscard]] std::string name_of(const ContactColumn<Row>& column, const PressureUnit& unit);

/// True if values of the column are pressures in kPa.
template <class Row>
[[nodiscard]] bool is_pressure(const ContactColumn<Row>& column) {
  return column.unit == kPressureUnits.front().name;
}

/// Formats a value, a pressure in `unit`, with the fewest digits that read back as the same double;
/// words have no quotes. Returns `unset` if the value is unset.
template <class Row>
[[nodiscard]] std::string text_of(const ContactColumn<Row>& column, const Row& row,
                                  const char* unset, const PressureUnit& unit);

/// The words of a column in the order of their indices: "none, given, ...".
template <class Row>
[[nodiscard]] std::string words_of(const ContactColumn<Row>& column);

}  // namespace pillarfield
