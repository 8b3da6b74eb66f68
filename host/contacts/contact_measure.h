#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "contacts/contact_totals.h"
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

  /// What a contact's pillars sum to, and with a friction their slip.
  [[nodiscard]] ContactTotals totals(std::span<const ContactRun> runs,
                                     std::optional<double> friction) const;

  /// All but the slip.
  [[nodiscard]] ContactQuantities quantities(const ContactSum& sum) const;

 private:
  ForceFieldView forces_;
  double pitch_mm_;
};

/// The coefficient, where it is known well enough to be reported.
[[nodiscard]] std::optional<double> known_friction(const ContactFriction& friction);

/// Adds what is known of a contact's friction, and what that says of its slip. `slip` is of
/// ContactMeasure::totals with it.
void set_slip(ContactQuantities& contact, const ContactFriction& friction, const PressingSum& slip);

}  // namespace pillarfield
