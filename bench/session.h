#pragma once

#include "bench/timing/interleaved_timing.h"
#include "pillarfield/processor.h"

namespace pillarfield::bench {

/// Device and timing length of all cases of a run.
struct Session {
  Device device;
  TimingLength length;
};

}  // namespace pillarfield::bench
