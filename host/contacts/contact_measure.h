#pragma once

#include <optional>

#include "contacts/contact_sum.h"
#include "pillarfield/contact_quantities.h"

namespace pillarfield {

/// What a contact's pillars exert, all but the slip.
[[nodiscard]] ContactQuantities quantities_of(const ContactSum& sum, double pillar_pitch_mm);

/// The shear / normal from which on a pillar slips.
[[nodiscard]] std::optional<double> slip_ratio(std::optional<double> friction);

/// The coefficient, where it is known well enough to be reported.
[[nodiscard]] std::optional<double> known_friction(const ContactFriction& friction);

/// Adds what is known of a contact's friction, and what that says of its slip. `sum` is
/// that with its slip_ratio().
void set_slip(ContactQuantities& contact, const ContactFriction& friction, const ContactSum& sum);

}  // namespace pillarfield
