#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/contact_totals.h"
#include "core/friction_plateau.h"
#include "pillarfield/contact_map.h"
#include "pillarfield/contact_quantities.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// How many pillars runs hold.
std::uint64_t pillars_of(std::span<const ContactRun> runs);

/// Reads a field as whole numbers, contact by contact.
class ContactMeasure {
 public:
  ContactMeasure(const ForceFieldView& forces, double pillar_pitch_mm);

  /// The friction that the pillars of a contact show. Of one of N pillars every k-th row is
  /// looked at, k = N / 500 rounded up, so that 250 to 500 pillars are; but 8 of its rows if it
  /// has as many. Those that bear a quarter of the largest force there, or more, are asked,
  /// weighted with their normal force: noise moves the ratio of the others. `scratch` is cleared
  /// first; who keeps it saves its memory.
  [[nodiscard]] std::optional<double> friction(std::span<const ContactRun> runs,
                                               FrictionHistogram& scratch) const;

  /// What a contact's pillars sum to, and with a friction their slip.
  [[nodiscard]] ContactTotals totals(std::span<const ContactRun> runs,
                                     std::optional<double> friction) const;

  /// All but the slip.
  [[nodiscard]] ContactQuantities quantities(const ContactSum& sum) const;

 private:
  ForceFieldView forces_;
  double pitch_mm_;
};

/// Adds what a friction says of a contact's slip. `slip` is of ContactMeasure::totals with it.
void set_slip(ContactQuantities& contact, double friction, FrictionSource source,
              const PressingSum& slip);

}  // namespace pillarfield
