#pragma once

#include "bench/ceiling.h"
#include "bench/frame_solver.h"
#include "bench/measurement.h"
#include "bench/race.h"
#include "bench/session.h"

namespace pillarfield::bench {

/// The copy kernels of a plan as contestants of a race.
class CeilingEntry {
 public:
  CeilingEntry(Race& race, const Device& device, const SolverPlan& plan, const Frames& frames,
               int frames_in_flight);

  /// After the race: the faster of the two, which is the ceiling.
  [[nodiscard]] std::size_t fastest(const Race& race) const;

  /// The counters `copy_cached` and `copy_streaming`, ns per pillar.
  void tell(const Race& race, Measurement& measured) const;

 private:
  double pillars_;
  CopyKernel cached_;
  CopyKernel streaming_;
  std::size_t cached_entry_;
  std::size_t streaming_entry_;
};

/// What every row that solves frames says of its plan and of the contestant that does.
Measurement measurement_of(const Race& race, std::size_t contestant, const SolverPlan& plan);

/// Races the solve of a plan with the copies of its streams.
Measurement race_solve(const Session& session, const SolverPlan& plan, const Scenery& scenery = {},
                       const Processor::Options& options = {});

}  // namespace pillarfield::bench
