#pragma once

#include <chrono>
#include <functional>

#include "pillarfield/frame_stream.h"
#include "pillarfield/pipeline.h"

namespace pillarfield {

/// Sends the frames of a stream through a ring: submits each frame on arrival if a slot is free,
/// and delivers the oldest while none arrives. More than one frame is in flight only if frames
/// arrive faster than they are solved. Allocates no memory.
///
/// A Ring has `int capacity()`; `int in_flight()`; `StreamedFrame& vacant()`, the buffer of the
/// next frame; `submit()`, which starts that frame; and `deliver()`, which waits for the oldest
/// one.
template <class Ring>
void run_frames(FrameStream& stream, Ring& ring, const std::function<bool()>& stop,
                PipelineStatistics& done) {
  constexpr std::chrono::milliseconds kPatience(100);
  std::uint64_t expected = 0;  // next sequence number
  bool knows_expected = false;
  for (bool open = true; open || ring.in_flight() > 0;) {
    if (open && stop && stop()) {
      done.stopped = true;
      open = false;
    }
    if (open && ring.in_flight() < ring.capacity()) {
      StreamedFrame& frame = ring.vacant();
      frame.sequence = expected;  // Streams may leave it where no frame arrives.
      const Arrival arrival =
          stream.next(frame, ring.in_flight() > 0 ? std::chrono::milliseconds(0) : kPatience);
      if (knows_expected && frame.sequence > expected) {
        done.lost += frame.sequence - expected;
        expected = frame.sequence;
      }
      open = arrival != Arrival::ended;
      if (arrival == Arrival::arrived) {
        expected = frame.sequence + 1;
        knows_expected = true;
        ring.submit();
        continue;
      }
    }
    if (ring.in_flight() > 0) ring.deliver();
  }
}

}  // namespace pillarfield
