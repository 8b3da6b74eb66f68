#pragma once

#include "contacts/contact_sum.h"
#include "pillarfield/contact_quantities.h"

namespace pillarfield {

/// The quantities of a contact, except friction and slip.
[[nodiscard]] ContactQuantities quantities_of(const ContactSum& sum, const Pitch& pitch_mm,
                                              bool has_shear = true);

/// Tells slipping pillars by the friction, or where it is not known well, by the least that it may
/// be. `noise_n` is the noise of a reading as a force, N.
[[nodiscard]] SlipTest slip_test(const ContactFriction& friction, double noise_n);

/// Sets friction, slip state and slip margin. `sum` is computed with the slip_test() of `friction`.
void set_slip(ContactQuantities& contact, const ContactFriction& friction, const ContactSum& sum);

}  // namespace pillarfield
