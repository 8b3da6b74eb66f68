#include "bench/frame_solver.h"

namespace pillarfield::bench {

FrameSolver::FrameSolver(const Device& device, const SolverPlan& plan, const Frames& frames,
                         const Processor::Options& options, const ProcessorTuning& tuning)
    : frames_(&frames),
      most_in_flight_(options.frames_in_flight),
      processor_(device, plan, options, tuning) {
  if (processor_.shares_memory()) return;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    copy_readings(frames[i], pinned_.emplace_back(processor_.frame_buffer()).bytes().data());
  }
}

void FrameSolver::run(int frames) {
  for (int i = 0; i < frames; ++i) {
    if (processor_.in_flight() == most_in_flight_) receive();
    const std::size_t next = submitted_++ % frames_->size();
    processor_.submit(pinned_.empty() ? (*frames_)[next] : pinned_[next].view());
  }
  while (processor_.in_flight() > 0) receive();
}

void FrameSolver::receive() {
  const ForceFieldView forces = processor_.receive();
  const auto time_s = static_cast<double>(received_++);
  if (tracker_ != nullptr) tracker_->update(forces, time_s, processor_.contacts());
}

ForceFieldView FrameSolver::solve(const FrameView& frame) {
  processor_.submit(frame);
  return processor_.receive();
}

}  // namespace pillarfield::bench
