#pragma once

#include "streams/live_sink.h"

namespace pillarfield {

/// A .mcap file of ROS 2 messages.
[[nodiscard]] LiveSinkKind mcap_sink_kind();

}  // namespace pillarfield
