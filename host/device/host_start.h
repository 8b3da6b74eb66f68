#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <thread>

#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Whether the host may solve the first frames of a plan while its kernels are compiled: it
/// computes all planes bit for bit, and frames leave nothing to the next ones.
[[nodiscard]] bool starts_on_host(const SolverPlan& plan);

/// Calls a function from its own thread after a delay, unless the object is destroyed before.
class LateCall {
 public:
  /// An empty `function` is not called.
  LateCall(std::chrono::milliseconds delay, std::function<void()> function);

 private:
  std::optional<std::jthread> thread_;  ///< ends with the object
};

}  // namespace pillarfield
