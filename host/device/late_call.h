#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <thread>

namespace pillarfield {

/// Calls a function, from a thread of its own, once the object has existed for a while.
class LateCall {
 public:
  /// Without a function it does nothing.
  LateCall(std::chrono::milliseconds delay, std::function<void()> function);

 private:
  std::optional<std::jthread> thread_;  ///< ends with the object
};

}  // namespace pillarfield
