#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "pillarfield/contact_tracker.h"

namespace pillarfield {

/// What the numbers of a column stand for.
enum class ColumnKind : std::uint8_t {
  count,     ///< a whole number
  identity,  ///< the same, where 0 stands for none
  number,    ///< NaN stands for unset
  word,      ///< the place of a word in its list
};

/// A column of a table of contacts, the same in every format. All values pass as double, which
/// holds every count there can be.
template <class Row>
struct ContactColumn {
  const char* name = "";  ///< with its unit: "shear_x_n"
  const char* unit = "";  ///< "N", "mm", ...; empty for plain numbers
  ColumnKind kind = ColumnKind::count;
  double (*get)(const Row&) = nullptr;
  void (*set)(Row&, double) = nullptr;    ///< takes any number, which may come from a damaged file
  const char* (*word)(double) = nullptr;  ///< of kind word
  bool later = false;                     ///< files of earlier versions lack it
};

/// id, parent, number, first_time_s, age_s.
[[nodiscard]] std::span<const ContactColumn<TrackedContact>> identity_columns();

/// The members of ContactQuantities.
[[nodiscard]] std::span<const ContactColumn<ContactQuantities>> quantity_columns();

/// id, merged_into, first_time_s, last_time_s.
[[nodiscard]] std::span<const ContactColumn<EndedContact>> ended_columns();

/// A value as text, in the fewest digits that read back as the same; words without quotes. Where
/// it is unset, `unset`.
template <class Row>
[[nodiscard]] std::string text_of(const ContactColumn<Row>& column, const Row& row,
                                  const char* unset);

/// The words of a column in the order of their numbers, "none, given, ...".
template <class Row>
[[nodiscard]] std::string words_of(const ContactColumn<Row>& column);

}  // namespace pillarfield
