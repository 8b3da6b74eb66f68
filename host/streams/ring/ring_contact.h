#pragma once

#include "pillarfield/contact_tracker.h"
#include "pillarfield/stream_format.h"

namespace pillarfield {

/// A contact, or a total, as a ring of results has it; without its moment on the surface.
[[nodiscard]] PillarfieldContact ring_contact(const ContactQuantities& of);
[[nodiscard]] PillarfieldContact ring_contact(const TrackedContact& tracked);

/// A contact of a ring in the frame of `time_s`; the inverse of ring_contact().
[[nodiscard]] TrackedContact contact_from(const PillarfieldContact& of, double time_s,
                                          SkinLayout layout);

}  // namespace pillarfield
