#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "pillarfield/contact_columns.h"
#include "pillarfield/contact_tracker.h"
#include "tests/io/sample_files.h"

namespace pillarfield::io_test {

/// Quantities that depend on `place` alone; every second one has unset members.
inline ContactQuantities sample_quantities(std::uint64_t place) {
  ContactQuantities quantities;
  std::uint64_t next = 0;
  for (const QuantityColumn& column : quantity_columns(true)) {
    const std::uint64_t number = number_at(place, next++);
    if (column.kind == ColumnKind::word) {
      column.set(quantities, static_cast<double>(place % 4));
    } else if (column.kind == ColumnKind::count) {
      column.set(quantities, static_cast<double>(number >> 20));
    } else if (place % 2 == 1 || !std::isnan(column.get({}))) {
      column.set(quantities, static_cast<double>(number) * 1e-19 - 0.7);
    }
  }
  return quantities;
}

/// Up to three contacts and two ended ones, depending on the frame's index.
inline FrameContacts sample_contacts(std::uint64_t index) {
  FrameContacts frame;
  frame.time_s = 0.25 * static_cast<double>(index);
  frame.total = sample_quantities(1000 * index);
  for (std::uint64_t i = 0; i < index % 4; ++i) {
    TrackedContact contact;
    contact.track_id = 10 * index + i + 1;
    contact.label = static_cast<std::uint32_t>(2 * i);
    if (i == 1) contact.parent = index + 1;
    contact.first_time_s = static_cast<double>(index) / 7;
    contact.age_s = static_cast<double>(i) / 3;
    contact.quantities = sample_quantities(1000 * index + i + 1);
    frame.contacts.push_back(contact);
  }
  for (std::uint64_t i = 0; i < index % 3; ++i) {
    frame.ended.push_back({index + i + 1, {}, static_cast<double>(i) / 9, frame.time_s});
    if (i == 1) frame.ended.back().merged_into = 5;
  }
  return frame;
}

/// All values in the order of the columns; `unset` for unset ones.
template <class Row>
std::string cells_of(std::span<const ContactColumn<Row>> columns, const Row& row,
                     const char* unset = "unset") {
  std::string cells;
  for (const auto& column : columns)
    cells += "," + text_of(column, row, unset, kPressureUnits.front());
  return cells;
}

inline std::string written_out(const FrameContacts& frame) {
  std::string text =
      std::to_string(frame.time_s) + "\npatch" + cells_of(quantity_columns(), frame.total);
  for (const TrackedContact& contact : frame.contacts) {
    text += "\ncontact" + cells_of(identity_columns(), contact) +
            cells_of(quantity_columns(), contact.quantities);
  }
  for (const EndedContact& contact : frame.ended) {
    text += "\nended" + cells_of(ended_columns(), contact);
  }
  return text;
}

}  // namespace pillarfield::io_test
