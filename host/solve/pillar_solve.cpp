#include "solve/pillar_solve.h"

#include <fmt/format.h>

#include <algorithm>

#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/tuning.h"
#include "solve/pillar_maths.h"
#include "solve/sensel_reader.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

class PillarSolver {
 public:
  PillarSolver(const SolverPlan& plan, const FrameView& frame, SensorState& state,
               ForceField& field)
      : sensels_(plan, frame, &state), field_(field) {
    if (!plan.uncertainty) return;
    for (auto& plane : field.uncertainty) plane.resize(field.pillars());
  }

  void solve(std::size_t row, std::size_t col) {
    const bool uncertainty = sensels_.stages().uncertainty;
    const maths::Noise noise = uncertainty ? sensels_.noise(row, col) : maths::Noise{};
    const maths::Solution solution =
        maths::solve_pillar(sensels_.pillar(row, col), noise, sensels_.stages());
    const std::size_t index = row * field_.cols + col;
    field_.status[index] = static_cast<std::uint8_t>(solution.status);
#define PF_STORE(name, unit, value) field_.name[index] = solution.value;
    PF_FORCE_PLANES(PF_STORE)
#undef PF_STORE
    if (!uncertainty) return;
#define PF_STORE(name, unit, value) field_.uncertainty[Uncertainty::name][index] = solution.value;
    PF_UNCERTAINTY_PLANES(PF_STORE)
#undef PF_STORE
  }

 private:
  SenselReader sensels_;
  ForceField& field_;
};

/// True if a pillar of the 3 x 3 neighbourhood is loaded.
bool is_touched(const ForceField& forces, std::size_t row, std::size_t col) {
  const std::size_t last_row = std::min<std::size_t>(row + 1, forces.rows - 1);
  const std::size_t last_col = std::min<std::size_t>(col + 1, forces.cols - 1);
  int bits = 0;
  for (std::size_t r = row == 0 ? 0 : row - 1; r <= last_row; ++r) {
    for (std::size_t c = col == 0 ? 0 : col - 1; c <= last_col; ++c) {
      bits |= forces.status[r * forces.cols + c];
    }
  }
  return (bits & PF_STATUS_PRESSED) != 0;
}

}  // namespace

void follow_baseline_on_host(SolverPlan& plan, const FrameView& frame, const ForceField& forces,
                             std::uint64_t index) {
  check(frame, plan.skin, plan.sensel_type, "follow_baseline_on_host");
  if (forces.rows != plan.skin.pillar_rows() || forces.cols != plan.skin.pillar_cols()) {
    throw Error("follow_baseline_on_host",
                fmt::format("the forces are {} x {}", forces.rows, forces.cols),
                "give the forces of this frame");
  }
  if (plan.calibration.tare.empty()) plan.calibration.tare.resize(plan.skin.sensels());
  SenselReader sensel(plan, frame);
  const auto rate = static_cast<float>(baseline_turn_rate(plan));
  const auto interval = static_cast<std::uint64_t>(plan.baseline_interval);
  for (std::size_t row = 0; row < 2 * std::size_t{forces.rows}; ++row) {
    if (row / 2 % interval != index % interval) continue;
    for (std::size_t col = 0; col < 2 * std::size_t{forces.cols}; ++col) {
      const bool untouched = !is_touched(forces, row / 2, col / 2);
      float& tare = plan.calibration.tare[row * frame.cols + col];
      tare = maths::follow_tare(tare, sensel.untared(row, col), untouched, rate);
    }
  }
}

ForceField solve_pillars(const SolverPlan& plan, const FrameView& frame, SensorState& state) {
  ForceField field(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  PillarSolver solver(plan, frame, state, field);
  for (std::size_t row = 0; row < field.rows; ++row) {
    for (std::size_t col = 0; col < field.cols; ++col) solver.solve(row, col);
  }
  return field;
}

}  // namespace pillarfield
