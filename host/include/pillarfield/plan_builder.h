#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/read_options.h"
#include "pillarfield/recording.h"
#include "pillarfield/scene.h"
#include "pillarfield/skin_calibration.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// The part of a plan that its frames state. `Frames` is a FrameSource or a FrameStream.
template <class Frames>
[[nodiscard]] SolverPlan plan_of_frames(const Frames& frames) {
  SolverPlan plan;
  plan.skin = frames.skin();
  plan.sensel_type = frames.sensel_type();
  plan.calibration = frames.calibration();
  return plan;
}

/// Seconds between frames: the median of the first ones, so that a gap does not count; 0.01 of a
/// single frame. Throws Error, naming `where`, if the times do not rise.
[[nodiscard]] double frame_interval_of(FrameSource& source, const std::string& where);

/// The sources of a plan beside its frames.
struct PlanSources {
  const Scene* scene = nullptr;                  ///< null: none
  const SkinCalibration* calibration = nullptr;  ///< null: none
  bool keeps_tare = false;                       ///< and noise, of the frames
  PlanSettings settings = {};
};

/// Applies the scene, the calibration and the settings, in this order, to the plan of frames.
/// Messages name them `where`. Calls `frame_interval_s` if the plan needs the time from frame to
/// frame and no setting gives it: for a followed baseline, hysteresis and creep. Where the noise is
/// known and no threshold above zero, the threshold becomes that of take_tare(), four standard
/// deviations, unless a setting gives it. Throws Error where the calibration does not fit.
[[nodiscard]] SolverPlan build_plan(SolverPlan plan, const PlanSources& from,
                                    const std::string& where,
                                    const std::function<double()>& frame_interval_s);

/// A user's statements about frames and their plan, in the options of a program.
struct PlanOptions {
  ReadOptions read = {};         ///< of the frames and the calibration
  std::string scene = {};        ///< file; empty: none
  std::string calibration = {};  ///< file; empty: none
  PlanSettings settings = {};
  mutable std::shared_ptr<const SkinCalibration> read_calibration = {};  ///< of calibration_of()
};

/// The calibration of the options, whose file is read once; null without one. Throws Error where it
/// cannot be read.
[[nodiscard]] const SkinCalibration* calibration_of(const PlanOptions& options);

/// The options of opening the frames: `read`, and the constants that the others, the calibration
/// and the scene give. Throws Error where one of these cannot be read.
[[nodiscard]] ReadOptions frame_options(const PlanOptions& options);

/// build_plan() with the files of the options; constants of `read` count as settings.
[[nodiscard]] SolverPlan build_plan(SolverPlan plan, const PlanOptions& options,
                                    const std::string& where,
                                    const std::function<double()>& frame_interval_s);

/// The size of frames that the calibration or the scene states. Throws as frame_options().
[[nodiscard]] std::optional<FrameSize> stated_size(const PlanOptions& options);

}  // namespace pillarfield
