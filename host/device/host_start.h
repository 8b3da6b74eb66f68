#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "pillarfield/host_solve.h"

namespace pillarfield {

/// Solves frames on the host while the kernels of a processor are compiled.
class HostStart {
 public:
  /// Whether the host computes all planes of a plan, bit for bit, and frames leave nothing to the
  /// next ones.
  [[nodiscard]] static bool serves(const SolverPlan& plan);

  HostStart(SolverPlan plan, int slots);

  /// Solves a frame. Throws Error if it does not fit the plan.
  void submit(const FrameView& frame);

  /// The forces of the oldest frame not yet received; requires one. They stay valid for as many
  /// further frames as there are slots.
  [[nodiscard]] ForceFieldView receive();

  [[nodiscard]] std::size_t in_flight() const { return submitted_ - received_; }
  [[nodiscard]] std::size_t slots() const { return results_.size(); }
  [[nodiscard]] const SolverPlan& plan() const { return plan_; }

 private:
  SolverPlan plan_;
  std::vector<ForceField> results_;
  std::size_t submitted_ = 0;
  std::size_t received_ = 0;
};

/// Calls a function from its own thread after a delay, unless the object is destroyed before.
class LateCall {
 public:
  /// An empty `function` is not called.
  LateCall(std::chrono::milliseconds delay, std::function<void()> function);

 private:
  std::optional<std::jthread> thread_;  ///< ends with the object
};

}  // namespace pillarfield
