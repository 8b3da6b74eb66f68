#pragma once

#include <vector>

#include "base/thread_pool.h"
#include "device/slot.h"
#include "lanes/lane_plan.h"

namespace pillarfield {

/// How the host solves the frames of a plan with vectors.
struct LaneSettings {
  /// A row must have as many blocks of 2 x 2 sensels as the program has lanes.
  LaneSettings(const SolverPlan& plan, const LaneProgram& chosen);

  const LaneProgram* program;
  bool whole;  ///< in whole numbers
  Division division;
};

/// Calibration planes that lanes read, in memory order.
[[nodiscard]] std::vector<CalibrationPlane> lane_planes(const SolverPlan& plan,
                                                        const LaneSettings& settings);

/// A frame that the host solves at once, in submit(): in the calling thread and, if it is large, in
/// those of a pool.
class LaneSlot final : public Slot {
 public:
  /// `pool` may be null and must outlive the slot's last submit().
  LaneSlot(const SolverPlan& plan, const LaneSettings& settings,
           const CalibrationMemory& calibration, FrameOrder& order, ThreadPool* pool);

  /// The next frames are solved by another plan of the same frames and outputs.
  void set_plan(const SolverPlan& plan, const LaneSettings& settings,
                const CalibrationMemory& calibration);

  void submit(const FrameView& frame, const std::optional<Curvature>& bent,
              const single_precision::Drift& drift) override;
  void wait() override {}
  bool is_done() override { return true; }
  [[nodiscard]] const ResultMemory& memory() const override { return memory_; }

 private:
  LaneSlot(const SolverPlan& plan, const LaneSettings& settings,
           const CalibrationMemory& calibration, FrameOrder& order, ThreadPool* pool,
           const SlotLayout& slot);
  /// Points to the readings of the frame, as float unless in whole numbers.
  void read(const FrameView& frame);
  /// Calls `work` with each piece, in the threads of the pool if there is one.
  template <class Work>
  void share(std::size_t pieces, const Work& work);
  void run(LaneProgram::Run work, LaneRange range);

  LanePlan plan_;
  const LaneProgram* program_;
  LaneRange bands_;
  LaneRange tiles_;  ///< none without crosstalk of wires
  bool corrects_;    ///< forces, by those of the pillars around
  ThreadPool* pool_;
  HostMemory memory_;
  LaneFrame frame_;
  std::uint32_t padded_cols_;
  std::vector<float> readings_;  ///< of a frame that cannot be read in place
};

}  // namespace pillarfield
