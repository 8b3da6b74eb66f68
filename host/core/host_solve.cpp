#include "core/host_solve.h"

#include "core/force_scale.h"
#include "core/pillar_maths.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

/// A frame's sensels after the stages of a plan.
class SenselReader {
 public:
  SenselReader(const SolverPlan& plan, const FrameView& frame) : plan_(plan), frame_(frame) {}

  [[nodiscard]] maths::Sensel operator()(std::size_t row, std::size_t col) const {
    const Calibration& calibration = plan_.calibration;
    const std::size_t index = row * frame_.cols + col;
    maths::Sensel sensel = maths::raw_sensel(raw(row, col));
    if (frame_.type == SenselType::f32) {
      sensel = maths::reject_absurd(sensel, static_cast<float>(kMaxCounts));
    }
    if (!calibration.mask.empty()) sensel = maths::apply_mask(sensel, calibration.mask[index]);
    if (plan_.skin.full_scale_counts) {
      sensel = maths::mark_saturated(sensel, static_cast<float>(*plan_.skin.full_scale_counts));
    }
    if (!calibration.tare.empty()) sensel = maths::subtract_tare(sensel, calibration.tare[index]);
    if (!calibration.gain.empty()) sensel = maths::apply_gain(sensel, calibration.gain[index]);
    sensel = maths::classify(sensel, static_cast<float>(plan_.skin.threshold_counts));
    if (!calibration.dead_zone.empty()) {
      sensel = maths::fill_dead_zone(sensel, calibration.dead_zone[index]);
    }
    return sensel;
  }

 private:
  [[nodiscard]] float raw(std::size_t row, std::size_t col) const {
    const std::size_t index = row * frame_.row_stride + col;
    switch (frame_.type) {
      case SenselType::u8:
        return static_cast<const std::uint8_t*>(frame_.data)[index];
      case SenselType::u16:
        return static_cast<const std::uint16_t*>(frame_.data)[index];
      case SenselType::f32:
        break;
    }
    return static_cast<const float*>(frame_.data)[index];
  }

  const SolverPlan& plan_;
  const FrameView& frame_;
};

}  // namespace

ForceField solve_on_host(const SolverPlan& plan, const FrameView& frame) {
  const SenselReader sensel(plan, frame);
  const ForceScale scale = force_scale(plan.skin.counts_per_newton);
  const maths::ForceScale single_scale = {static_cast<float>(scale.shear),
                                          static_cast<float>(scale.normal)};
  ForceField field(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  std::size_t index = 0;
  for (std::size_t row = 0; row < field.rows; ++row) {
    for (std::size_t col = 0; col < field.cols; ++col, ++index) {
      const maths::Pillar pillar = {sensel(2 * row, 2 * col + 1), sensel(2 * row, 2 * col),
                                    sensel(2 * row + 1, 2 * col), sensel(2 * row + 1, 2 * col + 1)};
      const maths::Diagonals diagonals = maths::pillar_diagonals(pillar);
      const maths::ParitySum sum = maths::parity_sum(diagonals);
      const maths::Force force = maths::direct_force(diagonals, sum, single_scale);
      maths::Bits bits = maths::direct_status(pillar, sum);
      if (plan.parity_tolerance_counts &&
          maths::fails_parity(pillar, sum, static_cast<float>(plan.skin.threshold_counts),
                              static_cast<float>(*plan.parity_tolerance_counts)) != 0) {
        bits |= PF_STATUS_INCONSISTENT;
      }
      field.shear_x[index] = force.shear_x;
      field.shear_y[index] = force.shear_y;
      field.normal[index] = force.normal;
      field.status[index] = static_cast<std::uint8_t>(bits);
    }
  }
  return field;
}

}  // namespace pillarfield
