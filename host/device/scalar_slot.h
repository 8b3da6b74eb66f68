#pragma once

#include <memory>

#include "device/slot.h"
#include "pillarfield/host_solve.h"

namespace pillarfield {

/// A frame of a skin with a single column of pillars, too narrow for vectors, which the host solves
/// in submit(), one pillar at a time.
class ScalarSlot final : public Slot {
 public:
  /// The slots of a processor share the plan and the state that frames leave.
  struct Sequence {
    SolverPlan plan;
    SensorState state;
  };

  ScalarSlot(std::shared_ptr<Sequence> sequence, const CalibrationMemory& calibration,
             FrameOrder& order);

  /// The next frames of all slots are solved by another plan of the same frames and outputs.
  void set_plan(const SolverPlan& plan) { sequence_->plan = plan; }

  void submit(const FrameView& frame, const std::optional<Curvature>& bent,
              const single_precision::Drift& drift) override;
  void wait() override {}
  bool is_done() override { return true; }
  [[nodiscard]] const ResultMemory& memory() const override { return memory_; }

 private:
  void store(const ForceField& forces);

  std::shared_ptr<Sequence> sequence_;
  const CalibrationMemory* calibration_;
  HostMemory memory_;
};

}  // namespace pillarfield
