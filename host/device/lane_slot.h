#pragma once

#include "device/slot.h"
#include "lanes/lane_solver.h"

namespace pillarfield {

/// A frame that the host solves at once, in submit().
class LaneSlot final : public Slot {
 public:
  /// `pool` may be null and must outlive the slot's last submit().
  LaneSlot(const SolverPlan& plan, const LaneSettings& settings,
           const CalibrationMemory& calibration, FrameOrder& order, ThreadPool* pool)
      : Slot(plan.skin, order), solver_(plan, settings, calibration, pool) {}

  /// The next frames are solved by another plan of the same frames and outputs.
  void set_plan(const SolverPlan& plan, const LaneSettings& settings,
                const CalibrationMemory& calibration) {
    solver_.set_plan(plan, settings, calibration);
  }

  void submit(const FrameView& frame, const std::optional<Curvature>& bent,
              const single_precision::Drift& drift) override {
    FrameStep step = {++order().frame, bent, {}};
    if (order().follows_baseline) {
      step.baseline = {order().pace, drift, order().first_row(), order().interval};
    }
    solver_.solve(frame, step);
  }
  void wait() override {}
  bool is_done() override { return true; }
  [[nodiscard]] const ResultMemory& memory() const override { return solver_.memory(); }

 private:
  LaneSolver solver_;
};

}  // namespace pillarfield
