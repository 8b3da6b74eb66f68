#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "pillarfield/live.h"
#include "tests/streams/source/assembler_run.h"

namespace pillarfield::streams_test {

/// Writes all bytes; for pipes that have room for them.
inline void write_all(int descriptor, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t size = write(descriptor, bytes.data() + done, bytes.size() - done);
    ASSERT_GT(size, 0) << std::strerror(errno);
    done += static_cast<std::size_t>(size);
  }
}

/// Takes frames until none comes for `patience` or ends; true at the end.
template <class Take>
bool take_frames(FrameStream& stream, std::chrono::nanoseconds patience, Take take) {
  StreamedFrame frame(stream.sensel_type(), stream.skin());
  for (;;) {
    // next() may return early, so a stream without frames is polled twice.
    Arrival arrival = stream.next(frame, patience);
    if (arrival == Arrival::timed_out) arrival = stream.next(frame, patience);
    if (arrival != Arrival::arrived) return arrival == Arrival::ended;
    take(frame);
  }
}

inline std::string bytes_of(const StreamedFrame& frame) {
  const auto bytes = frame.buffer.bytes();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace pillarfield::streams_test
