#include "cli/options/plan_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/warnings.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "pillarfield/scene.h"
#include "pillarfield/tuning.h"

namespace pillarfield::cli {
namespace {

/// Default time constant of the baseline with --everything, seconds.
constexpr double kBaselineTimeS = 10;

/// Baseline interval of --everything: at most 64 frames and 1/100 of the time constant.
int baseline_interval_of(double baseline_time_s, double frame_interval_s) {
  constexpr double kMostFrames = 64;
  return static_cast<int>(std::clamp(baseline_time_s / (100 * frame_interval_s), 1.0, kMostFrames));
}

bool has_output(const PlanOptions& options, const char* output) {
  return std::ranges::find(options.outputs, output) != options.outputs.end();
}

/// Applies the scene and returns its time constant of the baseline.
std::optional<double> apply_scene(const std::string& file, SolverPlan& plan) {
  const Scene scene = load_scene_with_warnings(file);
  set_skin(plan.skin, scene);
  set_solver(plan, scene);
  return scene.baseline_time_s;
}

void apply_calibration(const PlanOptions& options, const std::string& source, SolverPlan& plan) {
  const SkinCalibration calibration = read_calibration_file(options.calibration, options.read);
  require_fitting(calibration, plan.skin, source);
  const SensorEffects& effects = calibration.planes.effects;
  if (options.read.tare_frames > 0 && effects.wires && !has_offset_tares(effects)) {
    throw Error(
        "--tare-frames", "the tare of a skin with crosstalk of wires needs its calibration",
        fmt::format("write one: pillarfield calibrate tare UNLOADED --calibration {} -o FILE",
                    printable(options.calibration)));
  }
  // The tare of --tare-frames stays.
  const std::vector<float> tare = plan.calibration.tare;
  const std::vector<float> noise = plan.calibration.noise;
  apply(calibration, plan.skin, plan.calibration);
  if (options.read.tare_frames == 0) return;
  plan.calibration.tare = tare;
  plan.calibration.noise = noise;
}

void apply_numbers(const PlanOptions& options, SolverPlan& plan) {
  if (options.read.sensel_pitch_mm) plan.skin.sensel_pitch_mm = *options.read.sensel_pitch_mm;
  if (options.threshold_counts) plan.skin.threshold_counts = *options.threshold_counts;
  if (options.counts_per_newton) plan.skin.counts_per_newton = *options.counts_per_newton;
  if (options.full_scale_counts) plan.skin.full_scale_counts = options.full_scale_counts;
  if (options.parity_tolerance_counts) {
    plan.parity_tolerance_counts = options.parity_tolerance_counts;
  }
  if (options.noise_counts) plan.noise_counts = options.noise_counts;
}

/// Enables all outputs, the parity test and the baseline; earlier settings stay.
void enable_everything(SolverPlan& plan, std::optional<double>& baseline_time_s) {
  plan.angles = true;
  plan.uncertainty = true;
  if (!baseline_time_s) baseline_time_s = kBaselineTimeS;
  if (!plan.parity_tolerance_counts) {
    // The residual is one of four readings, the margin five deviations of three.
    plan.parity_tolerance_counts = region_margin(plan) * std::sqrt(4.0 / 3);
  }
}

void apply_friction(const PlanOptions& options, FrictionKnowledge& friction) {
  if (options.friction) friction.given = options.friction;
  if (options.friction_bound) friction.bound = options.friction_bound;
  if (!options.friction_prior.empty()) {
    friction.median = options.friction_prior[0];
    friction.spread = options.friction_prior[1];
  }
  if (options.unrelated_frames) friction.memory = false;
}

void apply_segment_point(const PlanOptions& options, const std::string& source, SolverPlan& plan) {
  if (!options.segment_point) return;
  if (plan.estimator == Estimator::paper) {
    throw Error(source, "--segment-point has no effect on the paper's estimator",
                "leave it out or give another --estimator");
  }
  plan.segment_point = *options.segment_point;
}

}  // namespace

ReadOptions frame_options(const PlanOptions& options) {
  ReadOptions read = options.read;
  read.counts_per_newton = options.counts_per_newton;
  read.threshold_counts = options.threshold_counts;
  read.full_scale_counts = options.full_scale_counts;
  return read;
}

SolverPlan plan_of(const PlanOptions& options, SolverPlan plan, const std::string& source,
                   const std::function<double()>& frame_interval_s) {
  std::optional<double> baseline_time_s;
  if (!options.scene.empty()) baseline_time_s = apply_scene(options.scene, plan);
  if (!options.calibration.empty()) apply_calibration(options, source, plan);
  apply_numbers(options, plan);
  if (options.baseline_time_s) baseline_time_s = options.baseline_time_s;
  if (options.estimator) plan.estimator = *options.estimator;
  apply_segment_point(options, source, plan);
  apply_friction(options, plan.friction);
  if (!options.outputs.empty()) {
    plan.angles = has_output(options, "angles");
    plan.uncertainty = has_output(options, "uncertainty");
  }
  if (options.everything) enable_everything(plan, baseline_time_s);
  const auto& memory = plan.calibration.effects.memory;
  if (!baseline_time_s && !memory) return plan;
  const double interval_s = frame_interval_s();
  plan.frame_interval_s = interval_s;
  if (!baseline_time_s) return plan;
  plan.baseline_rate = baseline_rate(*baseline_time_s, interval_s);
  if (options.everything)
    plan.baseline_interval = baseline_interval_of(*baseline_time_s, interval_s);
  if (options.baseline_interval) plan.baseline_interval = *options.baseline_interval;
  return plan;
}

}  // namespace pillarfield::cli
