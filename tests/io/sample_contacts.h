#pragma once

#include <cstdint>
#include <string>

#include "io/contact_columns.h"
#include "pillarfield/contact_tracker.h"
#include "tests/io/sample_files.h"

namespace pillarfield::io_test {

/// Quantities that depend on `place` alone; every second one has unset members.
inline ContactQuantities sample_quantities(std::uint64_t place) {
  ContactQuantities quantities;
  std::uint64_t next = 0;
  const auto value = [&] { return static_cast<double>(number_at(place, next++)) * 1e-19 - 0.7; };
  quantities.pillars = number_at(place, 100) >> 20;
  quantities.ambiguous = number_at(place, 101) >> 30;
  quantities.resolved = number_at(place, 102) >> 40;
  quantities.shear_x_n = value();
  quantities.shear_y_n = value();
  quantities.normal_n = value();
  quantities.centre_of_pressure = {value(), value()};
  quantities.centre = {value(), value()};
  quantities.torque_nmm = value();
  quantities.area_mm2 = value();
  quantities.peak_n = value();
  quantities.peak = {value(), value()};
  quantities.mean_pressure_kpa = value();
  quantities.slip = static_cast<SlipState>(place % 4);
  if (place % 2 == 0) return quantities;
  quantities.friction = value();
  quantities.friction_deviation = value();
  quantities.friction_source = static_cast<FrictionSource>(place % 3 + 1);
  quantities.slipping_share = value();
  quantities.slip_margin = value();
  quantities.slip_forecast = {value(), value(), value(), {value(), value(), value()}};
  quantities.wrench = {{value(), value(), value()}, {value(), value(), value()}};
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
