#pragma once

#include "streams/live_sink.h"

namespace pillarfield {

/// `foxglove:[ADDRESS:]PORT`: a WebSocket server of ROS 2 messages.
[[nodiscard]] LiveSinkKind foxglove_sink_kind();

}  // namespace pillarfield
