#pragma once

#include <cstdint>

#include "pillarfield/indenter.h"

namespace pillarfield {

/// Pose of an indenter at `time_s`: linear between keys, constant before the first and after the
/// last.
[[nodiscard]] IndenterKey state_at(const Indenter& indenter, double time_s);

/// Number of steps from frame 0 to the end of the indenter's path or of the frames.
[[nodiscard]] double steps_of(const Indenter& indenter, double rate_hz, std::uint64_t frames);

}  // namespace pillarfield
