#pragma once

#include "bench/frames.h"
#include "pillarfield/processor.h"
#include "pillarfield/tuning.h"

namespace pillarfield::bench {

/// A processor that works through a series of frames, as many in flight as it has slots for.
/// `frames` must outlive it.
class FrameSolver {
 public:
  FrameSolver(const Device& device, const SolverPlan& plan, const Frames& frames,
              const Processor::Options& options = {}, const ProcessorTuning& tuning = {});

  /// Solves so many frames, going on where it stopped.
  void run(int frames);

  /// Solves one frame; the result stays until run() or the next solve(). From half precision it has
  /// no magnitude and angles.
  ForceFieldView solve(const FrameView& frame);

 private:
  void receive();

  const Frames* frames_;
  int most_in_flight_;
  bool half_output_;
  Processor processor_;
  ForceField from_half_;  ///< the last result of solve(), where results are in half precision
  std::size_t submitted_ = 0;
};

}  // namespace pillarfield::bench
