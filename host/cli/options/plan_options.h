#pragma once

#include <functional>
#include <string>

#include "pillarfield/plan_builder.h"
#include "pillarfield/read_options.h"

namespace pillarfield::cli {

/// Options of the solver plan.
struct PlanOptions {
  ReadOptions read;  ///< of the frames and the calibration
  std::string scene;
  std::string calibration;
  PlanSettings settings;
};

/// The options of opening the frames: `read`, and the constants that the others give.
[[nodiscard]] ReadOptions frame_options(const PlanOptions& options);

/// build_plan() with the files of the options; a `source` that is a scene is applied too. Throws
/// Error where a file cannot be read or does not fit.
[[nodiscard]] SolverPlan plan_of(const PlanOptions& options, SolverPlan plan,
                                 const std::string& source,
                                 const std::function<double()>& frame_interval_s);

}  // namespace pillarfield::cli
