#include "bench/force_error.h"

#include <algorithm>
#include <cmath>

#include "bench/variant_solver.h"
#include "evaluation/bound.h"
#include "pillarfield/status.h"
#include "pillarfield/tuning.h"
#include "skin/pillar_sensels.h"

namespace pillarfield::bench {
namespace {

using bound::Force;

constexpr double kFar = 5;  ///< standard deviations

/// Sensels as the bound models them: they read V above threshold plus dead zone, with the noise of
/// a calibrated reading.
class SenselsOfPlan {
 public:
  explicit SenselsOfPlan(const SolverPlan& plan)
      : skin_(plan.skin), calibration_(plan.calibration), noise_counts_(reading_noise(plan)) {}

  [[nodiscard]] bound::Sensels of_pillar(std::uint32_t row, std::uint32_t col) const {
    const auto at = pillar_sensels(skin_, row, col);
    return {sensel(at[0]), sensel(at[1]), sensel(at[2]), sensel(at[3])};
  }

  [[nodiscard]] bool is_intact(std::uint32_t row, std::uint32_t col) const {
    return std::ranges::all_of(pillar_sensels(skin_, row, col),
                               [&](std::size_t at) { return is_good(calibration_, at); });
  }

 private:
  [[nodiscard]] PillarSensor sensel(std::size_t at) const {
    const auto value = [&](const std::vector<float>& plane, double otherwise) {
      return plane.empty() ? otherwise : plane[at];
    };
    const double gain = value(calibration_.gain, 1);
    const double dead_zone = value(calibration_.dead_zone, 0);
    PillarSensor sensor;
    sensor.counts_per_newton = skin_.counts_per_newton;
    sensor.threshold_counts = skin_.threshold_counts + dead_zone;
    sensor.noise_counts = noise_counts_ * gain;
    if (skin_.full_scale_counts) {
      sensor.full_scale_counts =
          (*skin_.full_scale_counts - value(calibration_.tare, 0)) * gain + dead_zone;
    }
    return sensor;
  }

  const Skin& skin_;
  const Calibration& calibration_;
  double noise_counts_;
};

bool is_far_below_full_scale(Force force, const bound::Sensels& sensels) {
  const auto v = double_precision::model_readings(force, sensels[0].counts_per_newton);
  const double most = std::max({v.v1, v.v2, v.v3, v.v4});
  return std::ranges::all_of(sensels, [&](const PillarSensor& sensel) {
    return !sensel.full_scale_counts ||
           most <= *sensel.full_scale_counts - kFar * sensel.noise_counts;
  });
}

bool has_bound(Force force, const bound::Sensels& sensels) {
  return bound::usable_sensels(force, sensels) >= 3 &&
         bound::is_far_from_borders(force, sensels, kFar) &&
         is_far_below_full_scale(force, sensels);
}

double squared_error(const ForceFieldView& solved, std::size_t pillar, Force truth) {
  const double x = solved.shear_x[pillar] - truth.shear_x;
  const double y = solved.shear_y[pillar] - truth.shear_y;
  const double z = solved.normal[pillar] - truth.normal;
  return x * x + y * y + z * z;
}

/// Sums over the pillars of all frames; squares of newtons.
class Sums {
 public:
  explicit Sums(const SolverPlan& plan) : plan_(plan), sensels_(plan) {}

  void add(const ForceFieldView& solved, const NoisyFrames& frames, std::size_t frame) {
    for_each_pillar(plan_.skin, [&](std::uint32_t row, std::uint32_t col, const auto& /*at*/) {
      const std::size_t pillar = std::size_t{row} * solved.cols + col;
      const Force truth = frames.truth(frame, row, col);
      const double error = squared_error(solved, pillar, truth);
      ++all_;
      all_errors_ += error;
      ambiguous_ += (solved.status[pillar] & status::kAmbiguous) != 0 ? 1U : 0U;
      const bound::Sensels sensels = sensels_.of_pillar(row, col);
      if (!sensels_.is_intact(row, col) || !has_bound(truth, sensels)) return;
      const double least = bound::least_error(truth, sensels);
      ++bounded_;
      errors_ += error;
      errors_over_bound_ += error / (least * least);
    });
  }

  [[nodiscard]] ForceError result() const {
    const double coarse_counts = plan_.skin.counts_per_newton / count_scale(plan_.sensel_type);
    const auto bounded = static_cast<double>(bounded_);
    const auto all = static_cast<double>(all_);
    return {coarse_counts * std::sqrt(errors_ / bounded), std::sqrt(errors_over_bound_ / bounded),
            bounded_, coarse_counts * std::sqrt(all_errors_ / all),
            static_cast<double>(ambiguous_) / all};
  }

 private:
  const SolverPlan& plan_;
  SenselsOfPlan sensels_;
  std::size_t all_ = 0;
  std::size_t bounded_ = 0;
  std::size_t ambiguous_ = 0;
  double all_errors_ = 0;
  double errors_ = 0;
  double errors_over_bound_ = 0;
};

}  // namespace

ForceError measure_force_error(const Device& device, const SolveVariant& variant,
                               const SolverPlan& plan, const NoisyFrames& frames,
                               std::size_t count) {
  VariantSolver solver(device, variant, plan, frames.frames());
  Sums sums(plan);
  for (std::size_t i = 0; i < count; ++i) sums.add(solver.solve(frames.frames()[i]), frames, i);
  return sums.result();
}

}  // namespace pillarfield::bench
