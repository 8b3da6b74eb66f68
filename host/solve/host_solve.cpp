#include "pillarfield/host_solve.h"

#include <fmt/format.h>

#include <algorithm>

#include "contacts/estimator/contact_estimator.h"
#include "pillarfield/error.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"
#include "solve/pillar_maths.h"
#include "solve/sensel_reader.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

/// Solves one pillar after the other into a field.
class PillarSolver {
 public:
  PillarSolver(const SolverPlan& plan, const FrameView& frame, ForceField& field)
      : plan_(plan),
        sensel_(plan, frame),
        field_(field),
        doubt_(static_cast<float>(region_doubt(plan))),
        segment_point_(static_cast<float>(plan.segment_point)) {
    const ForceScale scale = force_scale(plan.skin.counts_per_newton);
    scale_ = {static_cast<float>(scale.shear), static_cast<float>(scale.normal)};
    if (!plan.uncertainty) return;
    for (auto& plane : field.uncertainty) plane.resize(field.pillars());
  }

  void solve(std::size_t row, std::size_t col) {
    const maths::Pillar pillar = sensel_.pillar(row, col);
    const maths::Diagonals diagonals = maths::pillar_diagonals(pillar);
    const maths::ParitySum sum = maths::parity_sum(diagonals, segment_point_);
    const std::size_t index = row * field_.cols + col;
    const maths::Force force = plan_.estimator == Estimator::paper
                                   ? maths::paper_force(pillar, diagonals, sum, scale_)
                                   : maths::direct_force(diagonals, sum, scale_);
    field_.shear_x[index] = force.shear_x;
    field_.shear_y[index] = force.shear_y;
    field_.normal[index] = force.normal;
    field_.status[index] = static_cast<std::uint8_t>(status(pillar, diagonals, sum));
    if (!plan_.uncertainty) return;
    const std::size_t top = 2 * row;
    const std::size_t left = 2 * col;
    const maths::Noise noise = {sensel_.noise(top, left + 1), sensel_.noise(top, left),
                                sensel_.noise(top + 1, left), sensel_.noise(top + 1, left + 1)};
    store(maths::force_deviations(pillar, diagonals, sum, noise, segment_point_, scale_), index);
    const maths::Direction direction = maths::direction_of(force);
    store(maths::direction_interval(pillar, diagonals, sum, direction, scale_), index);
  }

 private:
  [[nodiscard]] maths::Bits status(const maths::Pillar& pillar, const maths::Diagonals& diagonals,
                                   const maths::ParitySum& sum) const {
    maths::Bits bits = maths::direct_status(pillar, diagonals, sum, doubt_);
    if (plan_.parity_tolerance_counts) {
      const auto tolerance = static_cast<float>(*plan_.parity_tolerance_counts);
      bits |= maths::fails_parity(pillar, sum, tolerance) ? PF_STATUS_INCONSISTENT : 0;
    }
    return bits;
  }

  void store(const maths::Force& deviations, std::size_t index) {
    auto& planes = field_.uncertainty;
    planes[Uncertainty::shear_x][index] = deviations.shear_x;
    planes[Uncertainty::shear_y][index] = deviations.shear_y;
    planes[Uncertainty::normal][index] = deviations.normal;
  }

  void store(const maths::DirectionInterval& interval, std::size_t index) {
    auto& planes = field_.uncertainty;
    planes[Uncertainty::theta_low][index] = interval.theta_low;
    planes[Uncertainty::theta_high][index] = interval.theta_high;
    planes[Uncertainty::phi_low][index] = interval.phi_low;
    planes[Uncertainty::phi_high][index] = interval.phi_high;
    planes[Uncertainty::magnitude_low][index] = interval.magnitude_low;
    planes[Uncertainty::magnitude_high][index] = interval.magnitude_high;
  }

  const SolverPlan& plan_;
  SenselReader sensel_;
  ForceField& field_;
  float doubt_;
  float segment_point_;
  maths::ForceScale scale_{};
};

/// Whether anything presses in the 3 x 3 pillars around one.
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
  const SenselReader sensel(plan, frame);
  const auto rate = static_cast<float>(baseline_turn_rate(plan));
  const auto interval = static_cast<std::uint64_t>(plan.baseline_interval);
  for (std::size_t row = 0; row < 2 * std::size_t{forces.rows}; ++row) {
    if (row / 2 % interval != index % interval) continue;
    for (std::size_t col = 0; col < 2 * std::size_t{forces.cols}; ++col) {
      const bool untouched = !is_touched(forces, row / 2, col / 2);
      float& tare = plan.calibration.tare[row * frame.cols + col];
      tare = maths::follow_tare(tare, sensel.judged(row, col), untouched, rate);
    }
  }
}

ForceField solve_on_host(const SolverPlan& plan, const FrameView& frame) {
  check(plan, "solve_on_host");
  check(frame, plan.skin, plan.sensel_type, "solve_on_host");
  ForceField field(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  PillarSolver solver(plan, frame, field);
  for (std::size_t row = 0; row < field.rows; ++row) {
    for (std::size_t col = 0; col < field.cols; ++col) solver.solve(row, col);
  }
  if (plan.estimator == Estimator::contact) ContactEstimator(plan).resolve(field);
  return field;
}

}  // namespace pillarfield
