#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

class CurvatureFollower;
class DriftFollower;

/// Solves one frame in the calling thread, without OpenCL; link `pillarfield::core`.
///
///     ForceField forces = solve_on_host(plan, frame.view());
///
/// It computes what Processor computes, from the same source in single precision. Results agree bit
/// for bit, except for the estimator `paper`, which calls library functions. It is the reference
/// for tests of devices, and the simplest choice for small skins and single frames: it compiles no
/// kernel but solves one pillar at a time.
///
/// `frame` has the plan's size and type, with any row stride; the result is [pillar rows, pillar
/// cols] and owns its memory. The function has no state: the estimator `contact` treats each frame
/// separately (as with FrictionKnowledge::memory off), sensels with a memory are at rest before it,
/// and the tare follows the readings only through follow_baseline_on_host(). `plan.angles` has no
/// effect.
///
/// Throws Error if the plan is out of range or the frame does not fit it. Threads: any number at
/// once.
[[nodiscard]] ForceField solve_on_host(const SolverPlan& plan, const FrameView& frame);

/// The state that passes from a frame to the next: hysteresis and creep of the sensels
/// (SenselMemory), the curvature of the skin, and the drift of its tares. Empty: at rest, and flat.
struct SensorState {
  std::vector<std::uint32_t> states;  ///< as Memory of the kernels, [pillar rows, cols, words]
  std::uint32_t frame = 0;            ///< number of frames so far
  std::vector<float> tare;            ///< of the bent skin, counts, [sensel rows, cols]
  std::shared_ptr<CurvatureFollower> curvature;  ///< made with the first frame of a bent skin
  std::shared_ptr<DriftFollower> drift;          ///< made with the first frame that is followed
};

/// Solves one frame of a sequence: sensels are in `state` before it, which is updated.
[[nodiscard]] ForceField solve_on_host(const SolverPlan& plan, const FrameView& frame,
                                       SensorState& state);

/// Moves `plan.calibration.tare` towards the readings of untouched sensels, and that of touched
/// ones by the drift that these share, as Processor does after each frame if `plan.baseline_rate`
/// is set. `forces` is the result of `frame`. `state` holds the drift, and the number of frames
/// followed so far, which selects the pillar rows whose turn it is (SolverPlan::baseline_interval).
/// An empty tare counts as zero. Throws Error if the frame or the forces do not fit the plan.
void follow_baseline_on_host(SolverPlan& plan, const FrameView& frame, const ForceField& forces,
                             SensorState& state);

}  // namespace pillarfield
