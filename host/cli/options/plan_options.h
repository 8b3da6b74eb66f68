#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/read_options.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::cli {

/// Options of the solver plan; unset ones leave the value of the file.
struct PlanOptions {
  ReadOptions read;  ///< of the frames and the calibration
  std::string scene;
  std::string calibration;
  std::optional<Estimator> estimator;
  std::optional<double> segment_point;
  std::optional<double> friction;
  std::optional<double> friction_bound;
  std::vector<double> friction_prior;  ///< empty, or median and spread
  bool unrelated_frames = false;
  std::vector<std::string> outputs;
  std::optional<double> threshold_counts;
  std::optional<double> counts_per_newton;
  std::optional<double> full_scale_counts;
  std::optional<double> parity_tolerance_counts;
  std::optional<double> noise_counts;
  std::optional<double> baseline_time_s;
  std::optional<int> baseline_interval;
  bool everything = false;
};

/// The options of opening the frames: `read`, and the constants that the others give.
[[nodiscard]] ReadOptions frame_options(const PlanOptions& options);

/// Applies the scene, the calibration and the other options, in this order, to `plan`. Messages
/// name the frames `source`. Calls `frame_interval_s`, the seconds between frames, if the baseline
/// is followed or the sensels have a memory. Throws Error where a file cannot be read or does not
/// fit.
[[nodiscard]] SolverPlan plan_of(const PlanOptions& options, SolverPlan plan,
                                 const std::string& source,
                                 const std::function<double()>& frame_interval_s);

}  // namespace pillarfield::cli
