#include "bench/frame_solver.h"

namespace pillarfield::bench {

FrameSolver::FrameSolver(const Device& device, const SolverPlan& plan, const Frames& frames,
                         const Processor::Options& options, const ProcessorTuning& tuning)
    : frames_(&frames),
      most_in_flight_(options.frames_in_flight),
      half_output_(plan.half_output),
      processor_(device, plan, options, tuning) {}

void FrameSolver::run(int frames) {
  for (int i = 0; i < frames; ++i) {
    if (processor_.in_flight() == most_in_flight_) receive();
    processor_.submit((*frames_)[submitted_++]);
  }
  while (processor_.in_flight() > 0) receive();
}

void FrameSolver::receive() {
  if (half_output_) {
    static_cast<void>(processor_.receive_half());
  } else {
    static_cast<void>(processor_.receive());
  }
}

ForceFieldView FrameSolver::solve(const FrameView& frame) {
  processor_.submit(frame);
  if (!half_output_) return processor_.receive();
  from_half_ = to_single(processor_.receive_half());
  return from_half_.view();
}

}  // namespace pillarfield::bench
