#pragma once

#include <chrono>
#include <functional>

#include "pillarfield/frame_stream.h"
#include "pillarfield/pipeline.h"

namespace pillarfield {

/// Sends the frames of a stream through a ring: each as soon as it is there and the ring has room,
/// and while none comes, the oldest is delivered. Only where frames come faster than they are
/// solved is more than one in flight. Takes no memory.
///
/// Ring: `int capacity()`; `int in_flight()`; `StreamedFrame& vacant()`, the place for the next
/// frame; `submit()`, which starts the frame in it; and `deliver()`, which waits for the oldest.
template <class Ring>
void run_frames(FrameStream& stream, Ring& ring, const std::function<bool()>& stop,
                PipelineStatistics& done) {
  constexpr std::chrono::milliseconds kPatience(100);
  std::uint64_t expected = 0;  // the sequence number that comes next
  bool knows_expected = false;
  for (bool open = true; open || ring.in_flight() > 0;) {
    if (open && stop && stop()) {
      done.stopped = true;
      open = false;
    }
    if (open && ring.in_flight() < ring.capacity()) {
      StreamedFrame& frame = ring.vacant();
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
