#pragma once

#include "streams/live_sink.h"

namespace pillarfield {

/// `shm:NAME`: a ring of results in shared memory (stream_format.h). append() writes into it and
/// never waits.
[[nodiscard]] LiveSinkKind ring_sink_kind();

}  // namespace pillarfield
