#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <thread>

namespace pillarfield {

/// Calls a function from its own thread after a delay, unless the object is destroyed before.
class LateCall {
 public:
  /// An empty `function` is not called.
  LateCall(std::chrono::milliseconds delay, std::function<void()> function);

 private:
  std::optional<std::jthread> thread_;  ///< ends with the object
};

}  // namespace pillarfield
