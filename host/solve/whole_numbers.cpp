#include "solve/whole_numbers.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace pillarfield {
namespace {

/// Largest threshold for whole numbers: four of them fit into 16 bits.
constexpr double kLargestWholeThreshold = 500;

/// Constants are clamped to this many counts: larger ones compare alike with readings of 8 bits.
constexpr double kManyCounts = 1000;

/// The segment point of whole-number programs: n of 1 - 1 / 2^n.
std::optional<int> whole_segment_point(const SolverPlan& plan) {
  for (int n = 1; n <= 3; ++n) {
    if (plan.segment_point == 1 - std::ldexp(1.0, -n)) return n;
  }
  return std::nullopt;
}

/// A limit in units, before it is rounded so that comparisons do not change.
double units_of(double counts) {
  return kUnitsPerCount * std::min<double>(static_cast<float>(counts), kManyCounts);
}

}  // namespace

bool is_whole(const SolverPlan& plan) {
  const Calibration& calibration = plan.calibration;
  const auto threshold = static_cast<float>(plan.skin.threshold_counts);
  const bool corrects = !calibration.tare.empty() || !calibration.gain.empty() ||
                        !calibration.dead_zone.empty() || !calibration.mask.empty() ||
                        !calibration.bend_x.empty() || !calibration.effects.empty() ||
                        plan.baseline_rate || plan.skin.power_law;
  const bool halves =
      threshold <= kLargestWholeThreshold && 2 * threshold == std::floor(2 * threshold);
  const bool saturates_below =
      plan.skin.full_scale_counts && static_cast<float>(*plan.skin.full_scale_counts) <= threshold;
  return plan.sensel_type == SenselType::u8 && plan.skin.has_pillars() &&
         plan.estimator != Estimator::paper && !corrects && !plan.angles && !plan.uncertainty &&
         halves && !saturates_below && whole_segment_point(plan);
}

bool is_whole(ConstantKind kind) {
  return kind == ConstantKind::above || kind == ConstantKind::from ||
         kind == ConstantKind::fraction;
}

double whole_value(const StageConstant& constant, const SolverPlan& plan) {
  switch (constant.kind) {
    case ConstantKind::exact:
      break;
    case ConstantKind::above:
      return std::floor(units_of(constant.value));
    case ConstantKind::from:
      return std::ceil(units_of(constant.value));
    case ConstantKind::per_count:
      return constant.value / kUnitsPerCount;
    case ConstantKind::fraction:
      return *whole_segment_point(plan);
  }
  return constant.value;
}

}  // namespace pillarfield
