#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/frame_solver.h"
#include "bench/session.h"
#include "bench/timing/ceiling.h"
#include "bench/timing/measurement.h"
#include "bench/timing/race.h"

namespace pillarfield::bench {

/// The copy kernels of a plan, of every kind, as contestants of a race.
class CeilingEntry {
 public:
  CeilingEntry(Race& race, const Device& device, const SolverPlan& plan, const Frames& frames,
               int frames_in_flight);

  /// After the race: the fastest of them, which is the ceiling.
  [[nodiscard]] std::size_t fastest(const Race& race) const;

  /// The counters `copy_<kind>`, ns per pillar.
  void tell(const Race& race, Measurement& measured) const;

 private:
  struct Entry {
    std::string name;
    std::unique_ptr<CopyKernel> kernel;  ///< the race keeps its address
    std::size_t number;                  ///< in the race
  };
  double pillars_;
  std::vector<Entry> entries_;
};

/// What every row that solves frames says of its plan and of the contestant that does.
Measurement measurement_of(const Race& race, std::size_t contestant, const SolverPlan& plan);

/// Races the solve of a plan with the copies of its streams.
Measurement race_solve(const Session& session, const SolverPlan& plan, const Scenery& scenery = {},
                       const Processor::Options& options = {}, const ProcessorTuning& tuning = {});

}  // namespace pillarfield::bench
