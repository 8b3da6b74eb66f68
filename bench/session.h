#pragma once

#include "bench/timing/interleaved_timing.h"
#include "pillarfield/processor.h"

namespace pillarfield::bench {

/// Devices and timing length of all cases of a run.
struct Session {
  Device solver;  ///< solves; if none was named, small skins are the host's
  Device device;  ///< of OpenCL: copies, and the paper's solve with one lane
  TimingLength length;
};

}  // namespace pillarfield::bench
