#pragma once

#include "bench/timing/race.h"
#include "pillarfield/processor.h"

namespace pillarfield::bench {

/// What all rows of a run have in common.
struct Session {
  Device device;
  RaceLength length;
};

}  // namespace pillarfield::bench
