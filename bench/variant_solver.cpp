#include "bench/variant_solver.h"

#include <algorithm>
#include <thread>

namespace pillarfield::bench {

VariantSolver::VariantSolver(const Device& device, const SolveVariant& variant,
                             const SolverPlan& plan, const Frames& frames)
    : frames_(&frames) {
  if (variant.arithmetic == Arithmetic::device_float) {
    on_device_.emplace(device, plan, frames);
  } else {
    in_double_.emplace(plan, std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
  }
}

void VariantSolver::run(int frames) {
  if (on_device_) {
    on_device_->run(frames);
  } else {
    in_double_->run(*frames_, frames);
  }
}

ForceFieldView VariantSolver::solve(const FrameView& frame) {
  return on_device_ ? on_device_->solve(frame) : in_double_->solve(frame);
}

}  // namespace pillarfield::bench
