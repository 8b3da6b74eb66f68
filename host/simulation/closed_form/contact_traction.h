#pragma once

#include <cstdint>

#include "pillarfield/closed_form_contact.h"
#include "pillarfield/force_field.h"
#include "simulation/pressure_moments.h"

namespace pillarfield {

/// Place and load of the contact at `time_s`: linear between keys, constant before the first and
/// after the last.
[[nodiscard]] ContactKey state_at(const ClosedFormContact& contact, double time_s);

/// Contact radius or half width under `load_n` newtons, mm: proportional to P^(1/3) under a sphere,
/// P^(1/2) under a cylinder, constant under a punch (C3).
[[nodiscard]] double contact_radius_mm(const ClosedFormContact& contact, double load_n);

/// Adds to `forces` the force of the contact at `state` on each pillar: its traction integrated
/// over the pillar's square cell of side `pitch_mm` (docs/derivations/contacts.md). The field is
/// centred on the origin; forces outside it are lost. Status bytes are unchanged.
///
/// Error: 1e-9 of the load. Cost: 0.04-0.5 µs per pillar of the contact's bounding box.
void add_contact(const ClosedFormContact& contact, const ContactKey& state, double pitch_mm,
                 ForceField& forces);

/// Adds the first moments of the contact's pressure about the axis of each pillar of a field of
/// `rows` by `cols`. Error: 1e-4 of load times pitch. Cost: 2 µs per pillar.
void add_pressure_moments(const ClosedFormContact& contact, const ContactKey& state,
                          double pitch_mm, std::uint32_t rows, std::uint32_t cols,
                          PressureMoments& moments);

}  // namespace pillarfield
