#include "device/host_start.h"

#include <condition_variable>
#include <mutex>
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

LateCall::LateCall(std::chrono::milliseconds delay, std::function<void()> function) {
  if (!function) return;
  thread_.emplace([delay, call = std::move(function)](const std::stop_token& ended) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any nothing;
    nothing.wait_for(lock, ended, delay, [] { return false; });
    if (!ended.stop_requested()) call();
  });
}

}  // namespace pillarfield
