#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "contacts/contact_sum.h"
#include "pillarfield/contact_map.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// The normal force of pillars that press, quanta.
struct PressingSum {
  std::int64_t pressing = 0;
  std::int64_t known = 0;     ///< of these, pillars whose readings determine the force
  std::int64_t slipping = 0;  ///< of these, pillars whose shear / normal is a given one or more

  void add(const PressingSum& other) {
    pressing += other.pressing;
    known += other.known;
    slipping += other.slipping;
  }
};

/// What is summed over pillars.
struct ContactTotals {
  ContactSum sum;
  PressingSum slip;  ///< zero where nothing is asked of slip
};

/// Sums over the pillars of runs; `least_ratio` is the shear / normal from which on a pillar slips,
/// unset: not asked. It is compared in single precision: a pillar within 10^-6 of it may fall on
/// either side, the same way each time. 1.3 to 2 ns a pillar.
[[nodiscard]] ContactTotals totals_of(const ForceFieldView& forces,
                                      std::span<const ContactRun> runs,
                                      std::optional<double> least_ratio);

/// The largest normal force of a pillar of the runs, N, if any is above zero; else zero.
[[nodiscard]] float peak_of(const ForceFieldView& forces, std::span<const ContactRun> runs);

}  // namespace pillarfield
