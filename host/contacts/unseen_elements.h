#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contacts/contact_sum.h"
#include "pillarfield/contact_quantities.h"

namespace pillarfield {

/// Elements under a contact whose own readings do not tell their force, filled in from the others
/// (docs/contacts_found.md).
struct UnseenElements {
  std::int64_t elements = 0;       ///< of them those that are no part of the contact's runs
  ContactSum fill;                 ///< what their forces add to the sums
  std::vector<ContactSum> errors;  ///< samples of the error of `fill`
};

/// Fills in the unseen elements of a contact, into an empty list where it has none; a second one
/// holds the error of those with the contact on one side only. Costs a test of eight status bytes
/// at a time where nothing is missing.
[[nodiscard]] std::vector<UnseenElements> unseen_elements(const ForceFieldView& forces,
                                                          std::span<const ContactRun> runs);

/// The quantities of a contact, or of several, of which `seen` is the sum and `unseen` independent.
[[nodiscard]] ContactQuantities quantities_of(ContactSum seen,
                                              std::span<const UnseenElements> unseen,
                                              const Pitch& pitch_mm, bool has_shear);

}  // namespace pillarfield
