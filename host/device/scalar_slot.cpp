#include "device/scalar_slot.h"

#include <algorithm>
#include <array>
#include <utility>

#include "solve/pillar_maths.h"
#include "solve/pillar_solve.h"
#include "solve/result_planes.h"

namespace pillarfield {

ScalarSlot::ScalarSlot(std::shared_ptr<Sequence> sequence, const CalibrationMemory& calibration,
                       FrameOrder& order)
    : Slot(sequence->plan.skin, order),
      sequence_(std::move(sequence)),
      calibration_(&calibration),
      memory_(ResultLayout(sequence_->plan, 0)) {}

/// Follows curvature and drift itself, in the state of the sequence.
void ScalarSlot::submit(const FrameView& frame, const std::optional<Curvature>& /*bent*/,
                        const single_precision::Drift& /*drift*/) {
  SolverPlan& plan = sequence_->plan;
  if (order().frame++ == 0) sequence_->state = {};
  if (calibration_->has_tare()) plan.calibration.tare = calibration_->tare();
  const ForceField forces = solve_pillars(plan, frame, sequence_->state);
  store(forces);
  if (!order().follows_baseline) return;
  follow_baseline_on_host(plan, frame, forces, sequence_->state);
  std::ranges::copy(plan.calibration.tare, reinterpret_cast<float*>(calibration_->bytes()));
}

void ScalarSlot::store(const ForceField& forces) {
  const ForceFieldView view = forces.view();
  std::ranges::copy(view.status, memory_.status());
  std::array<float*, kSolvedPlanes> planes{};
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    planes[i] = reinterpret_cast<float*>(memory_.plane(i));
    if (planes[i] != nullptr) std::ranges::copy(plane_of(view, i), planes[i]);
  }
  if (!sequence_->plan.angles) return;
  for (std::size_t i = 0; i < view.normal.size(); ++i) {
    const auto direction =
        single_precision::direction_of({view.shear_x[i], view.shear_y[i], view.normal[i]});
    planes[kForcePlanes][i] = direction.magnitude;
    planes[kForcePlanes + 1][i] = direction.theta;
    planes[kForcePlanes + 2][i] = direction.phi;
  }
}

}  // namespace pillarfield
