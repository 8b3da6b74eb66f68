#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Sensels of a live skin that seem faulty.
struct SenselHealth {
  std::uint64_t dead = 0;   ///< do not respond, or only at full scale, where their pillar does
  std::uint64_t stuck = 0;  ///< their reading is constant where the others of their pillar move
  /// Untouched, and off their tare by more than half the threshold.
  std::uint64_t drifting = 0;
};

/// Watches the sensels of a live skin in a thread of its own, which takes at most 20 frames a
/// second and a tenth of a core. FaultFinder finds dead and stuck sensels in windows of 10 s in
/// which their pillar moves; they count until they move again.
class SenselWatch {
 public:
  /// `window`: duration of a window. Throws Error if the plan is out of range.
  explicit SenselWatch(const SolverPlan& plan,
                       std::chrono::milliseconds window = std::chrono::seconds(10));
  ~SenselWatch();
  SenselWatch(const SenselWatch&) = delete;
  SenselWatch& operator=(const SenselWatch&) = delete;

  /// Copies the frame if the thread is ready for one, else does nothing; never waits. Pass only
  /// frames without missing readings. Calls come from one thread.
  void offer(const FrameView& frame);

  /// Starts again with another plan of the same frames, which has a new tare.
  void set_plan(const SolverPlan& plan);

  /// As of the last whole window; zero before.
  [[nodiscard]] SenselHealth health() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
