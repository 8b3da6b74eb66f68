#pragma once

#include <optional>

#include "contacts/contact_sum.h"
#include "pillarfield/contact_quantities.h"

namespace pillarfield {

/// The quantities of a contact, except friction and slip.
[[nodiscard]] ContactQuantities quantities_of(const ContactSum& sum, double pitch_mm,
                                              bool has_shear = true);

/// Ratio of shear to normal force above which a pillar counts as slipping.
[[nodiscard]] std::optional<double> slip_ratio(std::optional<double> friction);

/// The friction coefficient; unset if its source is the prior alone.
[[nodiscard]] std::optional<double> known_friction(const ContactFriction& friction);

/// Sets friction, slip state and slip margin. `sum` is computed with the slip_ratio() of
/// `friction`.
void set_slip(ContactQuantities& contact, const ContactFriction& friction, const ContactSum& sum);

}  // namespace pillarfield
