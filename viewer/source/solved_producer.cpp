#include "viewer/source/solved_producer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/status.h"

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

namespace {

SourceInfo truth_info(SourceInfo info) {
  info.name += ", truth";
  info.kind = "truth";
  Calibration absent;  // what has no sensel has no truth either
  absent.mask = std::move(info.calibration.mask);
  info.calibration = std::move(absent);
  info.has_readings = false;
  info.has_uncertainty = false;
  info.has_truth = false;
  info.solver = "true forces";
  info.warnings.clear();
  info.notes.clear();
  return info;
}

/// Every loaded element is determined.
void set_status(ForceField& truth) {
  for (std::size_t i = 0; i < truth.elements(); ++i) {
    const bool sheared = !truth.shear_x.empty() && (truth.shear_x[i] != 0 || truth.shear_y[i] != 0);
    const bool loaded = truth.normal[i] != 0 || sheared;
    truth.status[i] = loaded ? status::kUsable : 0;
  }
}

}  // namespace

TruthProducer::TruthProducer(const SourceInfo& solved, Reader read)
    : info_(truth_info(solved)),
      read_(std::move(read)),
      truth_(info_.skin),
      blocks_(kMostShown, [this] {
        return std::make_unique<PlaneBlock>(info_.skin.layout, info_.skin.element_rows(),
                                            info_.skin.element_cols(), false);
      }) {}

ShownField TruthProducer::produce(std::uint64_t index) {
  const std::shared_ptr<PlaneBlock> block = blocks_.acquire();
  if (block == nullptr) throw_all_fields_in_use();
  const double time_s = read_(index, truth_);
  set_status(truth_);
  block->copy(truth_.view());
  ShownField field;
  field.forces = block->view();
  field.time_s = time_s;
  field.index = index;
  field.pages = block->pages();
  field.keep_alive = block;
  return field;
}

}  // namespace pillarfield::viewer
