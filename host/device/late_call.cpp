#include "device/late_call.h"

#include <condition_variable>
#include <mutex>
#include <utility>

namespace pillarfield {

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
