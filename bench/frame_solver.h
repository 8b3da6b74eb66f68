#pragma once

#include <string>

#include "bench/frames.h"
#include "pillarfield/processor.h"
#include "pillarfield/tuning.h"

namespace pillarfield::bench {

/// Solves a series of frames with all slots of a processor in flight. `frames` must outlive it.
class FrameSolver {
 public:
  FrameSolver(const Device& device, const SolverPlan& plan, const Frames& frames,
              const Processor::Options& options = {}, const ProcessorTuning& tuning = {});

  /// Solves the next `frames` frames.
  void run(int frames);

  /// Solves one frame; the result is valid until run() or the next solve().
  ForceFieldView solve(const FrameView& frame);

  /// The name of the device that solves.
  [[nodiscard]] const std::string& device() const { return processor_.device().info().name; }

 private:
  void receive();

  const Frames* frames_;
  int most_in_flight_;
  Processor processor_;
  std::size_t submitted_ = 0;
};

}  // namespace pillarfield::bench
