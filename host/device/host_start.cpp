#include "device/host_start.h"

#include <utility>

#include "solve/stages.h"

namespace pillarfield {

bool HostStart::serves(const SolverPlan& plan) {
  return plan.estimator == Estimator::direct && !plan.angles && !has_memory_on_device(plan) &&
         plan.calibration.bend_x.empty();
}

HostStart::HostStart(SolverPlan plan, int slots)
    : plan_(std::move(plan)), results_(static_cast<std::size_t>(slots)) {}

void HostStart::submit(const FrameView& frame) {
  results_[submitted_ % results_.size()] = solve_on_host(plan_, frame);
  ++submitted_;
}

ForceFieldView HostStart::receive() { return results_[received_++ % results_.size()].view(); }

}  // namespace pillarfield
