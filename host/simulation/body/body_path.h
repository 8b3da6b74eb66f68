#pragma once

#include <cstdint>

#include "pillarfield/body.h"

namespace pillarfield {

/// Where a body is at `time_s`: linear between keys, constant before the first and after the last.
[[nodiscard]] BodyKey state_at(const Body& body, double time_s);

/// Steps from frame 0 until the body of a scene is at the end of its path or the frames are over.
[[nodiscard]] double steps_of(const Body& body, double rate_hz, std::uint64_t frames);

}  // namespace pillarfield
