#include "solve/curvature_follower.h"

#include <algorithm>
#include <cmath>

#include "pillarfield/tuning.h"
#include "skin/raw_reading.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostCurvatureSamples = 1024;
constexpr std::size_t kLeastCurvatureSamples = 512;
constexpr std::size_t kSenselsPerSample = 16;
constexpr double kUntouchedDeviations = 4;
constexpr double kLeastUntouched = 0.15;   // fraction of the samples
constexpr double kTrustedUntouched = 0.5;  // below, the rough fit is tried too
constexpr int kRoughPasses = 15;
constexpr int kRefiningPasses = 4;
constexpr double kAppliedPart = 0.1;  // of the noise

PatternTriple triple_of_curvature(const Curvature& curvature) {
  return {curvature.x, curvature.y, curvature.xy};
}

}  // namespace

CurvatureFollower::CurvatureFollower(const SolverPlan& plan) : cols_(plan.skin.cols) {
  const Calibration& calibration = plan.calibration;
  const std::size_t sensels = plan.skin.sensels();
  const std::size_t wanted =
      std::clamp(sensels / kSenselsPerSample, kLeastCurvatureSamples, kMostCurvatureSamples);
  const std::size_t step = std::max<std::size_t>(1, sensels / wanted);
  for (std::size_t i = step / 2; i < sensels; i += step) {
    if (!calibration.mask.empty() && calibration.mask[i] != 1) continue;
    const PatternTriple pattern = {calibration.bend_x[i], calibration.bend_y[i],
                                   calibration.bend_xy[i]};
    for (std::size_t k = 0; k < 3; ++k) spread_[k] += pattern[k] * pattern[k];
    const double tare = calibration.tare.empty() ? 0 : calibration.tare[i];
    samples_.push_back({i / plan.skin.cols, i % plan.skin.cols, pattern, tare});
  }
  for (double& spread : spread_) {
    spread = std::sqrt(spread / std::max<double>(1, static_cast<double>(samples_.size())));
  }
  noise_ = reading_noise_n(plan) * plan.skin.counts_per_newton;
  limit_ = std::max(kUntouchedDeviations * noise_, plan.skin.threshold_counts);
}

void CurvatureFollower::set_plan(const SolverPlan& plan) {
  const std::vector<float>& tare = plan.calibration.tare;
  noise_ = reading_noise_n(plan) * plan.skin.counts_per_newton;
  limit_ = std::max(kUntouchedDeviations * noise_, plan.skin.threshold_counts);
  for (Sample& sample : samples_) {
    const PatternTriple& pattern = sample.pattern;
    sample.tare = tare[sample.row * cols_ + sample.col] -
                  (applied_.x * pattern[0] + applied_.y * pattern[1] + applied_.xy * pattern[2]);
  }
}

double CurvatureFollower::left(const std::vector<double>& differences, std::size_t sample,
                               const PatternTriple& curvature) const {
  const PatternTriple& pattern = samples_[sample].pattern;
  return differences[sample] -
         (curvature[0] * pattern[0] + curvature[1] * pattern[1] + curvature[2] * pattern[2]);
}

PatternTriple CurvatureFollower::fit(const std::vector<double>& differences,
                                     const std::vector<double>& weights) const {
  PatternEquations equations;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    equations.add(samples_[i].pattern, differences[i], weights[i]);
  }
  return equations.solution();
}

CurvatureFollower::NearFit CurvatureFollower::fit_near(const std::vector<double>& differences,
                                                       const PatternTriple& curvature) const {
  PatternEquations equations;
  std::size_t near = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (!(std::abs(left(differences, i, curvature)) <= limit_)) continue;
    equations.add(samples_[i].pattern, differences[i]);
    ++near;
  }
  return {equations.solution(), static_cast<double>(near) / static_cast<double>(samples_.size())};
}

PatternTriple CurvatureFollower::rough_fit(const std::vector<double>& differences) const {
  std::vector<double> weights(samples_.size(), 1);
  PatternTriple curvature{};
  for (int pass = 0; pass < kRoughPasses; ++pass) {
    curvature = fit(differences, weights);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      weights[i] = 1 / std::max(limit_, std::abs(left(differences, i, curvature)));
    }
  }
  return curvature;
}

std::optional<Curvature> CurvatureFollower::follow(const FrameView& frame) {
  std::vector<double> differences(samples_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const double reading = raw_reading(frame, samples_[i].row, samples_[i].col);
    // A reading that is not a number is far off every curvature.
    differences[i] = std::isfinite(reading) ? reading - samples_[i].tare : kMaxPlaneCounts;
  }
  const PatternTriple before = triple_of_curvature(applied_);
  NearFit now = fit_near(differences, before);
  if (!started_ || now.part < kTrustedUntouched) {
    const NearFit rough = fit_near(differences, rough_fit(differences));
    if (rough.part > now.part) now = rough;
  }
  const int passes = started_ ? 1 : kRefiningPasses;
  for (int pass = 1; pass < passes && now.part >= kLeastUntouched; ++pass) {
    now = fit_near(differences, now.curvature);
  }
  if (now.part < kLeastUntouched) return std::nullopt;
  started_ = true;
  double change = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    change = std::max(change, std::abs(now.curvature[k] - before[k]) * spread_[k]);
  }
  if (change < kAppliedPart * noise_) return std::nullopt;
  applied_ = {now.curvature[0], now.curvature[1], now.curvature[2]};
  return Curvature{applied_.x - before[0], applied_.y - before[1], applied_.xy - before[2]};
}

}  // namespace pillarfield
