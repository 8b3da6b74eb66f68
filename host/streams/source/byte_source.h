#pragma once

#include <chrono>
#include <cstddef>
#include <span>

#include "streams/source/packet_source.h"

namespace pillarfield {

/// Reads of bytes without a packet after which receive() returns, as of /dev/zero.
inline constexpr int kMostReads = 64;

/// The result of read_bytes(): bytes, or the reason for none.
struct BytesRead {
  std::size_t bytes = 0;
  bool ended = false;  ///< end of file, or the device is gone
};

/// Waits for bytes of a pipe or a device, at most for `timeout`, and reads them.
[[nodiscard]] BytesRead read_bytes(int descriptor, std::span<std::byte> space,
                                   std::chrono::nanoseconds timeout);

/// Waits for a descriptor to become readable; false at the timeout and on a signal.
[[nodiscard]] bool wait_readable(int descriptor, std::chrono::nanoseconds timeout);

}  // namespace pillarfield
