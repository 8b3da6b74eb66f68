#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/read_options.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::cli {

/// What is computed and from which sensor, as far as the command line says.
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

/// The plan for frames of the skin, sensel type and calibration of `plan`: what the scene says of
/// them, then the calibration, then the other options. `source` names the frames in messages;
/// `frame_interval_s` is asked, where the baseline is followed, for the seconds between two frames.
/// Throws Error where a file cannot be read or does not fit.
[[nodiscard]] SolverPlan plan_of(const PlanOptions& options, SolverPlan plan,
                                 const std::string& source,
                                 const std::function<double()>& frame_interval_s);

}  // namespace pillarfield::cli
