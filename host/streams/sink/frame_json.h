#pragma once

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "pillarfield/live.h"
#include "streams/message/host_clock.h"
#include "streams/message/topics.h"

namespace pillarfield {

/// Total and contacts of frames as lines of JSON (docs/stream_sinks.md).
class FrameJson {
 public:
  explicit FrameJson(const LiveSinkInfo& info);

  /// The line of a frame, valid until the next call; empty if it lacks the contacts that the stream
  /// has. Contacts that the stream does not have are found in the frame's forces.
  [[nodiscard]] std::string_view line(const SolvedFrame& frame);

 private:
  std::optional<ContactTracker> tracker_;  // if frames come without contacts
  ContactSlots slots_;
  HostClock clock_;
  fmt::memory_buffer json_;
};

}  // namespace pillarfield
