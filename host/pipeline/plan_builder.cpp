#include "pillarfield/plan_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "pillarfield/tare.h"
#include "pillarfield/tuning.h"

namespace pillarfield {
namespace {

/// Default time constant of the baseline of PlanSettings::everything, seconds.
constexpr double kBaselineTimeDefaultS = 10;

void apply_calibration(const SkinCalibration& calibration, bool keeps_tare,
                       const std::string& where, SolverPlan& plan) {
  require_fitting(calibration, plan.skin, where);
  std::vector<float> tare = plan.calibration.tare;
  std::vector<float> noise = plan.calibration.noise;
  apply(calibration, plan.skin, plan.calibration);
  if (!keeps_tare) return;
  plan.calibration.tare = std::move(tare);
  plan.calibration.noise = std::move(noise);
}

/// Sets the threshold of a tare if the noise is known and nothing states a threshold.
void set_default_threshold(SolverPlan& plan) {
  const bool has_noise = plan.noise_counts || !plan.calibration.noise.empty();
  const std::vector<std::uint8_t>& mask = plan.calibration.mask;
  const bool has_good = mask.empty() || std::ranges::count(mask, kGood) > 0;
  if (!has_noise || !has_good || plan.skin.threshold_counts > 0) return;
  SkinCalibration calibration = blank_calibration(plan.skin);
  calibration.planes = plan.calibration;
  calibration.power_law = plan.skin.power_law;
  if (calibration.planes.noise.empty()) {
    calibration.planes.noise.assign(plan.skin.sensels(), static_cast<float>(reading_noise(plan)));
  }
  set_threshold(calibration, TareOptions{}.threshold_factor);
  plan.skin.threshold_counts = *calibration.threshold_counts;
}

/// Enables all outputs, and of pillars the parity test; an earlier tolerance stays.
void enable_everything(SolverPlan& plan) {
  plan.uncertainty = plan.pressure = true;
  if (!plan.skin.has_pillars()) return;
  plan.angles = true;
  if (plan.parity_tolerance_counts) return;
  // The residual is one of four readings, the margin five deviations of three.
  plan.parity_tolerance_counts = region_margin(plan) * std::sqrt(4.0 / 3);
}

}  // namespace

double frame_interval_of(FrameSource& source, const std::string& where) {
  constexpr double kIntervalOfOneFrameS = 0.01;
  constexpr std::uint64_t kMostIntervals = 100;  // The time of a frame may cost reading all of it.
  const std::uint64_t frames = std::min(source.frames(), kMostIntervals + 1);
  if (frames < 2) return kIntervalOfOneFrameS;
  std::vector<double> intervals;
  double before = source.time(0);
  for (std::uint64_t index = 1; index < frames; ++index) {
    const double time = source.time(index);
    intervals.push_back(time - std::exchange(before, time));
  }
  if (const double interval = median(intervals); interval > 0) return interval;
  throw Error(where, "the times of its frames do not rise",
              "give times that do, or leave out a followed baseline and creep");
}

SolverPlan build_plan(SolverPlan plan, const PlanSources& from, const std::string& where,
                      const std::function<double()>& frame_interval_s) {
  const PlanSettings& settings = from.settings;
  std::optional<double> baseline_time_s;
  if (from.scene != nullptr) {
    set_skin(plan.skin, *from.scene);
    set_solver(plan, *from.scene);
    baseline_time_s = from.scene->solver.baseline_time_s;
  }
  if (from.calibration != nullptr) {
    apply_calibration(*from.calibration, from.keeps_tare, where, plan);
  }
  apply(settings, plan);
  if (!settings.threshold_counts) set_default_threshold(plan);
  if (settings.baseline_time_s) baseline_time_s = settings.baseline_time_s;
  if (settings.everything) {
    enable_everything(plan);
    if (!baseline_time_s) baseline_time_s = kBaselineTimeDefaultS;
  }
  const bool is_timed = baseline_time_s || plan.calibration.effects.memory;
  if (is_timed && !settings.frame_interval_s) plan.frame_interval_s = frame_interval_s();
  if (baseline_time_s) set_baseline(plan, *baseline_time_s);
  if (settings.baseline_interval) {
    plan.baseline_interval = static_cast<int>(*settings.baseline_interval);
  }
  return plan;
}

namespace {

/// Refuses a tare of the frames where that of the calibration is needed behind its wires.
void check_tare_frames(const PlanOptions& options, const SensorEffects& effects) {
  if (options.read.tare_frames == 0 || !effects.wires || has_offset_tares(effects)) return;
  throw Error("--tare-frames", "the tare of a skin with crosstalk of wires needs its calibration",
              fmt::format("write one: pillarfield calibrate tare UNLOADED --calibration {} -o FILE",
                          printable(options.calibration)));
}

template <class Constant>
void take_known(std::optional<Constant>& constant, const std::optional<Constant>& known) {
  if (!constant) constant = known;
}

}  // namespace

const SkinCalibration* calibration_of(const PlanOptions& options) {
  if (!options.read_calibration && !options.calibration.empty()) {
    options.read_calibration = std::make_shared<const SkinCalibration>(
        read_calibration_file(options.calibration, options.read));
  }
  return options.read_calibration.get();
}

ReadOptions frame_options(const PlanOptions& options) {
  ReadOptions read = options.read;
  take_known(read.counts_per_newton, options.settings.counts_per_newton);
  take_known(read.threshold_counts, options.settings.threshold_counts);
  take_known(read.full_scale_counts, options.settings.full_scale_counts);
  std::optional<double> threshold;
  if (const SkinCalibration* const calibration = calibration_of(options)) {
    take_known(read.sensel_pitch_mm, calibration->sensel_pitch_mm);
    take_known(read.counts_per_newton, calibration->counts_per_newton);
    threshold = calibration->threshold_counts;
  }
  if (!options.scene.empty()) {
    const Skin skin = load_scene(options.scene).skin;
    take_known(read.sensel_pitch_mm, std::optional(skin.sensel_pitch_mm));
    take_known(read.counts_per_newton, std::optional(skin.counts_per_newton));
    take_known(threshold, std::optional(skin.threshold_counts));
  }
  if (read.tare_frames == 0) take_known(read.threshold_counts, threshold);
  return read;
}

SolverPlan build_plan(SolverPlan plan, const PlanOptions& options, const std::string& where,
                      const std::function<double()>& frame_interval_s) {
  PlanSources from = {.keeps_tare = options.read.tare_frames > 0, .settings = options.settings};
  PlanSettings& settings = from.settings;
  take_known(settings.layout, options.read.layout);
  take_known(settings.sensel_pitch_mm, options.read.sensel_pitch_mm);
  take_known(settings.counts_per_newton, options.read.counts_per_newton);
  take_known(settings.threshold_counts, options.read.threshold_counts);
  take_known(settings.full_scale_counts, options.read.full_scale_counts);
  std::optional<Scene> scene;
  if (!options.scene.empty()) from.scene = &scene.emplace(load_scene(options.scene));
  from.calibration = calibration_of(options);
  if (from.calibration != nullptr) check_tare_frames(options, from.calibration->planes.effects);
  return build_plan(std::move(plan), from, where, frame_interval_s);
}

std::optional<FrameSize> stated_size(const PlanOptions& options) {
  if (const SkinCalibration* const calibration = calibration_of(options)) {
    return FrameSize{calibration->rows, calibration->cols};
  }
  if (options.scene.empty()) return std::nullopt;
  const Skin skin = load_scene(options.scene).skin;
  return FrameSize{skin.rows, skin.cols};
}

}  // namespace pillarfield
