#pragma once

#include <cstdint>

#include "pillarfield/body.h"

namespace pillarfield {

/// Pose of a body at `time_s`: linear between keys, constant before the first and after the last.
[[nodiscard]] BodyKey state_at(const Body& body, double time_s);

/// Number of steps from frame 0 to the end of the body's path or of the frames.
[[nodiscard]] double steps_of(const Body& body, double rate_hz, std::uint64_t frames);

}  // namespace pillarfield
