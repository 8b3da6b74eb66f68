#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/thread_pool.h"
#include "lanes/calibration_memory.h"
#include "lanes/frame_memory.h"
#include "lanes/lane_plan.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// The program with which the host solves the frames of a plan, and their division.
struct LaneSettings {
  /// Takes the program with the most lanes, but not more than `most` if there is one, that a row
  /// fills.
  LaneSettings(const SolverPlan& plan, int most);

  const LaneProgram* program;
  bool whole;  ///< in whole numbers
  Division division;
};

/// The calibration planes that lanes read.
[[nodiscard]] CalibrationMemory lane_calibration(const SolverPlan& plan,
                                                 const LaneSettings& settings);

/// The update of a followed baseline after a frame: arguments of kernels/frame/follow_baseline.cl.
struct BaselineTurn {
  single_precision::BaselinePace pace{};
  single_precision::Drift drift{};
  std::uint32_t first_row = 0;
  std::uint32_t interval = 1;
};

/// The circumstances of a frame beside its readings.
struct FrameStep {
  std::uint64_t number = 1;              ///< of the frame, from 1 on
  std::optional<Curvature> bent;         ///< change of the skin's curvature before the frame
  std::optional<BaselineTurn> baseline;  ///< none: the tare stays
};

/// Solves frames with the vectors of the host: in the calling thread and, if they are large, in
/// those of a pool. Frames leave the states of sensels and the tare in the calibration planes,
/// which solvers may share.
class LaneSolver {
 public:
  /// `pool` may be null; pool and planes must outlive the last solve().
  LaneSolver(const SolverPlan& plan, const LaneSettings& settings,
             const CalibrationMemory& calibration, ThreadPool* pool = nullptr);

  /// The next frames are solved by another plan of the same frames and outputs.
  void set_plan(const SolverPlan& plan, const LaneSettings& settings,
                const CalibrationMemory& calibration);

  void solve(const FrameView& frame, const FrameStep& step);

  /// The results of the last frame.
  [[nodiscard]] const ResultMemory& memory() const { return narrow_ ? *narrow_ : memory_; }

 private:
  LaneSolver(const SolverPlan& plan, const LaneSettings& settings,
             const CalibrationMemory& calibration, ThreadPool* pool, const SlotLayout& slot);
  /// Points to the readings of the frame, as float unless in whole numbers.
  void read(const FrameView& frame);
  /// Calls `work` with each piece, in the threads of the pool if there is one.
  template <class Work>
  void share(std::size_t pieces, const Work& work);
  void run(LaneProgram::Run work, LaneRange range);

  LanePlan plan_;
  const LaneProgram* program_;
  LaneRange bands_;
  LaneRange tiles_;        ///< none without crosstalk of wires
  bool corrects_ = false;  ///< forces, by those of the pillars around
  ThreadPool* pool_;
  HostMemory memory_;
  std::optional<HostMemory> narrow_;  ///< the first column of `memory_`, of a skin without others
  LaneFrame frame_;
  std::size_t padded_cols_;
  std::vector<float> readings_;  ///< of a frame that cannot be read in place
};

/// Solves one frame of a valid plan, which it must fit; sensels are at rest before it. With the
/// estimator `contact`, returns the direct forces from which that one starts.
[[nodiscard]] ForceField solve_in_lanes(const SolverPlan& plan, const FrameView& frame);

}  // namespace pillarfield
