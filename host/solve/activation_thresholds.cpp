#include "solve/activation_thresholds.h"

#include <algorithm>
#include <cmath>

#include "solve/pillar_maths.h"
#include "solve/sensor_corrections.h"

namespace pillarfield {
namespace {

/// The reading at which the response reaches the threshold, reduced by more than the error of the
/// curve and of power_of().
double threshold_before_response(const SolverPlan& plan) {
  const double threshold = plan.skin.threshold_counts;
  const ResponseCurve& curve = plan.calibration.effects.curve;
  if (!curve.empty()) return reading_at(curve_polynomial(curve).polynomial, threshold) * (1 - 1e-4);
  if (!plan.skin.power_law) return threshold;
  const PowerLaw& law = *plan.skin.power_law;
  const double reading =
      law.reference_counts * std::pow(threshold / law.reference_counts, 1 / law.exponent);
  return reading * (1 - 1e-4);
}

double largest_reading(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return 255;
    case SenselType::u16:
      return 65535;
    case SenselType::f32:
      break;
  }
  return kMaxCounts;
}

}  // namespace

ActivationRange activation_range(const SolverPlan& plan) {
  const bool whole = plan.sensel_type != SenselType::f32;
  const double largest = largest_reading(plan.sensel_type);
  ActivationRange range{};
  range.threshold = threshold_before_response(plan);
  range.step = whole ? 1 : 0;
  range.lowest = whole ? 0 : -kMaxCounts;
  range.highest = std::min(largest, plan.skin.full_scale_counts.value_or(largest));
  if (whole) range.highest = std::floor(range.highest);
  range.never = largest;
  return range;
}

bool has_activation_plane(const SolverPlan& plan) {
  const Calibration& calibration = plan.calibration;
  return !calibration.tare.empty() || !calibration.gain.empty() || !calibration.mask.empty() ||
         !calibration.bend_x.empty() || plan.baseline_rate.has_value();
}

std::vector<float> activation_thresholds(const SolverPlan& plan) {
  const Calibration& calibration = plan.calibration;
  const ActivationRange range = activation_range(plan);
  const auto threshold = static_cast<float>(range.threshold);
  const auto lowest = static_cast<float>(range.lowest);
  const auto highest = static_cast<float>(range.highest);
  std::vector<float> thresholds(has_activation_plane(plan) ? plan.skin.sensels() : 1);
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    const float tare = calibration.tare.empty() ? 0 : calibration.tare[i];
    const float gain = calibration.gain.empty() ? 1 : calibration.gain[i];
    const float reading = single_precision::activation_threshold(
        tare, gain, threshold, static_cast<float>(range.step), lowest);
    thresholds[i] = std::min(std::max(reading, lowest), highest);
    if (!is_good(calibration, i)) thresholds[i] = static_cast<float>(range.never);
  }
  return thresholds;
}

double idle_load(const SolverPlan& plan) {
  constexpr double kRounding = 1;  // of the largest tare in single precision, counts
  const Calibration& calibration = plan.calibration;
  const ActivationRange range = activation_range(plan);
  double least_gain = 1;
  for (std::size_t i = 0; i < calibration.gain.size(); ++i) {
    if (is_good(calibration, i)) least_gain = std::min<double>(least_gain, calibration.gain[i]);
  }
  return range.threshold / least_gain + range.step + kRounding;
}

}  // namespace pillarfield
