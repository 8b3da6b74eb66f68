#include "device/host_start.h"

#include <condition_variable>
#include <mutex>
#include <utility>

#include "solve/stages.h"

namespace pillarfield {

bool starts_on_host(const SolverPlan& plan) {
  return plan.estimator == Estimator::direct && !plan.angles && !has_memory_on_device(plan) &&
         plan.calibration.bend_x.empty();
}

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
