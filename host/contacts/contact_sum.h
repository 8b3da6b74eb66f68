#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "pillarfield/contact_labels.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// What is summed over the pillars of a contact: forces in N; places in half pitches from the
/// patch's centre, x right and y up, odd or even as the patch has even or odd columns and rows.
struct ContactSum {
  double shear_x = 0;
  double shear_y = 0;
  double normal = 0;
  double normal_x = 0;   ///< of normal times x
  double normal_y = 0;   ///< of normal times y
  double shear_y_x = 0;  ///< of shear_y times x, one part of the torque
  double shear_x_y = 0;  ///< of shear_x times y, the other
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t pillars = 0;
  std::int64_t ambiguous = 0;
  std::int64_t resolved = 0;  ///< of these, by the friction of their contact
  float peak = -std::numeric_limits<float>::infinity();  ///< largest normal force
  std::int64_t peak_x = 0;
  std::int64_t peak_y = 0;
  /// Normal force of the pillars that press; of these, of those whose readings determine the force;
  /// of these, of those whose shear / normal is the ratio asked for or more. Zero where no ratio
  /// is.
  double pressing = 0;
  double determined = 0;
  double slipping = 0;

  /// Adds the pillars that come next, row by row: of equal peaks the first counts. The sum depends
  /// on the order of additions.
  void add(const ContactSum& next);
};

/// Sums over the pillars of runs, in their order; `least_ratio` is the shear / normal from which on
/// a pillar slips, unset: not asked. NaN and infinite forces count as zero. About 1 ns a pillar.
[[nodiscard]] ContactSum sum_of(const ForceFieldView& forces, std::span<const ContactRun> runs,
                                std::optional<double> least_ratio);

}  // namespace pillarfield
