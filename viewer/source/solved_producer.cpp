#include "viewer/source/solved_producer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

/// Keeps the memory and the readings of a field alive.
struct FieldMemoryOwner {
  Processor::PinnedResult result;
  std::shared_ptr<const FrameBuffer>
      readings;  ///< released first: a free slot implies a free frame
};

/// True if a frame uses the friction carried over from the frame before.
bool carries_prior(const SolverPlan& plan) {
  return estimator_of(plan) == Estimator::contact && plan.friction.memory;
}

}  // namespace

SolverPlan shown_plan(SolverPlan plan) {
  const bool knows_noise = plan.noise_counts.has_value() || !plan.calibration.noise.empty();
  plan.angles = plan.skin.has_pillars();
  plan.uncertainty = knows_noise && plan.estimator != Estimator::paper;
  plan.baseline_rate.reset();  // It would depend on the frames shown before.
  return plan;
}

void describe(SourceInfo& info, const SolverPlan& plan, const Processor& processor) {
  info.skin = plan.skin;
  info.calibration = plan.calibration;
  info.has_readings = true;
  info.has_angles = plan.angles;
  info.has_uncertainty = plan.uncertainty;
  set_sensor(info.contacts, plan);
  info.solver =
      solver_words(plan.skin.layout, name_of(estimator_of(plan)), processor.device().info().name);
}

SolvedProducer::SolvedProducer(SourceInfo info, std::shared_ptr<FrameProvider> provider,
                               const SolverPlan& plan, Processor processor)
    : info_(std::move(info)), provider_(std::move(provider)), processor_(std::move(processor)) {
  info_.frames = provider_->frames();
  if (plan.estimator == Estimator::direct) direct_point_ = plan.segment_point;
  if (!carries_prior(plan)) return;
  idle_frame_.emplace(plan.sensel_type, plan.skin.rows, plan.skin.cols);
}

void SolvedProducer::clear_prior() {
  // A prior lasts one frame, and an idle frame leaves none.
  processor_.submit(idle_frame_->view());
  static_cast<void>(processor_.receive());
}

ShownField SolvedProducer::produce(std::uint64_t index) {
  if (index >= info_.frames) {
    throw Error(info_.name, fmt::format("has no frame {}", index),
                fmt::format("it has {} frames, counted from 0", info_.frames));
  }
  if (processor_.pinned() == kMostShown) throw_all_fields_in_use();
  FrameHandle frame = provider_->frame(index);
  if (idle_frame_ && index != next_) clear_prior();
  const FrameView raw = frame.readings->view();
  processor_.submit(raw);
  const ForceFieldView forces = processor_.receive();
  next_ = index + 1;
  const auto held = std::make_shared<FieldMemoryOwner>(
      FieldMemoryOwner{processor_.pin(), std::move(frame.readings)});
  return {
      .forces = forces,
      .raw = raw,
      .time_s = frame.time_s,
      .index = index,
      .direct_point = direct_point_,
      .shear_coefficient = info_.calibration.effects.shear_coefficient.value_or(ShearCoefficient{}),
      .pages = held->result.pages(),
      .keep_alive = held};
}

bool SolvedProducer::refresh() {
  if (!provider_->refresh()) return false;
  info_.frames = provider_->frames();
  return true;
}

}  // namespace pillarfield::viewer
