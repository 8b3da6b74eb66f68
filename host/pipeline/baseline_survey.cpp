#include "pipeline/baseline_survey.h"

#include <algorithm>
#include <cmath>

namespace pillarfield {
namespace {

constexpr std::uint64_t kFramesOfDistance = 10;

std::uint64_t survey_step(const Checkpoints& checkpoints) {
  return std::max<std::uint64_t>(checkpoints.every / kFramesOfDistance, 1);
}

/// The plan for every step-th frame, without what does not change the tare.
SolverPlan survey_plan(SolverPlan plan, std::uint64_t step) {
  // A single frame never sets the tare, since its noise would.
  constexpr double kMostRate = 0.5;
  const auto frames = static_cast<double>(step);
  plan.baseline_rate = std::min(1 - std::pow(1 - *plan.baseline_rate, frames), kMostRate);
  plan.baseline_interval = 1;
  plan.frame_interval_s *= frames;
  if (plan.estimator == Estimator::contact) plan.estimator = Estimator::direct;
  plan.angles = plan.uncertainty = false;
  return plan;
}

}  // namespace

BaselineSurvey::BaselineSurvey(FrameSource& source, const Device& device, const SolverPlan& plan,
                               const Checkpoints& checkpoints)
    : source_(source),
      step_(survey_step(checkpoints)),
      frame_(plan.sensel_type, plan.skin.rows, plan.skin.cols),
      processor_(device, survey_plan(plan, step_)) {}

std::vector<float> BaselineSurvey::tare_at(std::uint64_t frame, const std::function<bool()>& stop) {
  for (; next_ < frame; next_ += step_) {
    if (stop && stop()) break;
    source_.read(next_, frame_);
    processor_.submit(frame_.view());
    static_cast<void>(processor_.receive());
  }
  return processor_.tare();
}

}  // namespace pillarfield
