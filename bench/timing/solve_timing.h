#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/frame_solver.h"
#include "bench/timing/copy_kernel.h"
#include "bench/timing/interleaved_timing.h"
#include "pillarfield/processor.h"

namespace pillarfield::bench {

/// Devices and timing length of all cases of a run.
struct Session {
  Device solver;  ///< solves; if none was named, small skins are the host's
  Device device;  ///< of OpenCL: copies, and the paper's solve with one lane
  TimingLength length;
};

/// Result of a case.
struct Measurement {
  double seconds = 0;  ///< median time of a frame
  std::map<std::string, double> counters;
  std::string label;
};

/// Registers a case. `measure` runs when the case is selected; an exception becomes its error.
void add_case(const std::string& name, std::function<Measurement()> measure);

/// The copy kernels of a plan, of every kind, as candidates of a timing.
class CopyEntries {
 public:
  CopyEntries(InterleavedTiming& timing, const Device& device, const SolverPlan& plan,
              const Frames& frames, int frames_in_flight);

  /// After run(): the fastest copy, which is the copy bandwidth limit.
  [[nodiscard]] std::size_t fastest(const InterleavedTiming& timing) const;

  /// Adds the counters `copy_<kind>`, ns per pillar.
  void report(const InterleavedTiming& timing, Measurement& measured) const;

 private:
  struct Entry {
    std::string name;
    std::unique_ptr<CopyKernel> kernel;  ///< the timing holds its address
    std::size_t candidate;
  };
  double pillars_;
  std::vector<Entry> entries_;
};

/// Counters of every case that solves frames: of its plan and of one candidate.
Measurement measurement_of(const InterleavedTiming& timing, std::size_t candidate,
                           const SolverPlan& plan);

/// Times the solve of a plan, interleaved with the copies of its streams.
Measurement time_solve(const Session& session, const SolverPlan& plan,
                       const Scenario& scenario = {}, const Processor::Options& options = {},
                       const ProcessorTuning& tuning = {});

}  // namespace pillarfield::bench
