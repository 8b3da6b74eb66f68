#pragma once

#include "streams/live_sink.h"

namespace pillarfield {

/// `udp:ADDRESS:PORT`: one datagram of JSON a frame.
[[nodiscard]] LiveSinkKind udp_sink_kind();

}  // namespace pillarfield
