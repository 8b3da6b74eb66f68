#pragma once

// The feasible segment of an ambiguous pillar with two adjacent usable sensels: all forces that are
// consistent with its readings (docs/derivations/segment.md).

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "pillarfield/sensor_effects.h"
#include "pillarfield/status.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// True if shear_y, not shear_x, varies along the segment: the usable sensels are the upper or the
/// lower two.
[[nodiscard]] inline bool shear_y_is_free(std::uint8_t status) {
  const int usable = status & status::kUsable;
  return usable == 3 || usable == 12;
}

/// Sign of the shear that presses the usable sensels: 1 if they are the upper or the right two.
[[nodiscard]] inline float sign_of_free_shear(std::uint8_t status) {
  const int usable = status & status::kUsable;
  return usable == 3 || usable == 9 ? 1.0F : -1.0F;
}

/// Properties of a sensor on which its segments depend, besides the forces.
struct SegmentModel {
  float point = 0;     ///< segment point of direct forces; 0: forces anywhere on their segments
  float hidden_n = 0;  ///< normal force below the threshold, N, if `point` is 0
  float coefficient_x = 1;  ///< ShearCoefficient
  float coefficient_y = 1;
  float pitch_over_arm = 0;              ///< of off-centre pressure; 0: none
  float residual = 0;                    ///< ResidualError::relative
  double slope_x = std::numbers::sqrt2;  ///< over coefficient_x
  double slope_y = std::numbers::sqrt2;

  [[nodiscard]] bool is_ideal() const {
    return coefficient_x == 1 && coefficient_y == 1 && pitch_over_arm == 0;
  }
  /// Decrease of the free shear component per newton of normal force (F6).
  [[nodiscard]] double slope(bool vertical) const { return vertical ? slope_y : slope_x; }
};

/// The model of a sensor with the coefficients and the arm of `effects`.
[[nodiscard]] inline SegmentModel segment_model(const SensorEffects& effects, double pitch_mm) {
  const ShearCoefficient coefficient = effects.shear_coefficient.value_or(ShearCoefficient{});
  SegmentModel model;
  model.coefficient_x = static_cast<float>(coefficient.x);
  model.coefficient_y = static_cast<float>(coefficient.y);
  model.slope_x = std::numbers::sqrt2 / coefficient.x;
  model.slope_y = std::numbers::sqrt2 / coefficient.y;
  if (effects.residual) model.residual = static_cast<float>(effects.residual->relative);
  if (effects.arm_mm) model.pitch_over_arm = static_cast<float>(pitch_mm / *effects.arm_mm);
  return model;
}

/// Shear that off-centre pressure adds to a pillar's, N, and its standard deviation.
struct LeanShear {
  float x = 0;
  float y = 0;
  float deviation = 0;  ///< of a component
};

/// A segment of forces. One shear component is known; the other is free: towards the usable sensels
/// it is `free_shear` at zero normal force and falls by `slope` per newton of normal force.
struct FeasibleSegment {
  float known_shear;  ///< magnitude of the known component, N
  float free_shear;   ///< N; below zero only if off-centre pressure was subtracted
  float high;         ///< largest normal force, N; the least is zero
  double slope;

  /// Shear over normal force at the normal force `normal` > 0, N.
  [[nodiscard]] double ratio_at(double normal) const {
    const double rest = free_shear - slope * normal;
    return std::sqrt(double{known_shear} * known_shear + rest * rest) / normal;
  }
  /// The normal force of the least ratio: `high`, unless off-centre pressure was subtracted (F7).
  [[nodiscard]] double least_ratio_normal() const {
    const double pull = slope * free_shear;
    const double square = double{known_shear} * known_shear + double{free_shear} * free_shear;
    return square < pull * high ? square / pull : high;
  }
  /// The normal force of the shortest force, N.
  [[nodiscard]] double shortest_normal() const {
    return std::clamp(slope * free_shear / (1 + slope * slope), 0.0, double{high});
  }
};

/// The feasible segment through a force (F1, F2, F6); `lean` is what was subtracted from it.
[[nodiscard]] inline FeasibleSegment segment_of(const single_precision::Force& point,
                                                std::uint8_t status, const SegmentModel& model,
                                                const LeanShear& lean) {
  const bool vertical = shear_y_is_free(status);
  const float sign = sign_of_free_shear(status);
  const double slope = model.slope(vertical);
  const float known_shear = vertical ? point.shear_x : point.shear_y;
  const float free_shear =
      sign * (vertical ? point.shear_y : point.shear_x) + static_cast<float>(slope) * point.normal;
  if (model.point > 0)
    return {std::abs(known_shear), free_shear, point.normal / model.point, slope};
  const float free_read = (vertical ? model.coefficient_y : model.coefficient_x) *
                          (free_shear + sign * (vertical ? lean.y : lean.x));
  const float known_read = (vertical ? model.coefficient_x : model.coefficient_y) *
                           std::abs(known_shear + (vertical ? lean.x : lean.y));
  const float read = std::max(free_read - known_read, 0.0F);
  return {std::abs(known_shear), free_shear,
          read / (2 * std::numbers::sqrt2_v<float>)+model.hidden_n, slope};
}

/// The force with the normal force `normal`, N, on the segment through `point` (F2).
[[nodiscard]] inline single_precision::Force force_on_segment(const single_precision::Force& point,
                                                              std::uint8_t status,
                                                              const SegmentModel& model,
                                                              float normal) {
  const bool vertical = shear_y_is_free(status);
  const float grown = static_cast<float>(model.slope(vertical)) * (normal - point.normal);
  const float shear = vertical ? point.shear_y : point.shear_x;
  const float free_shear = shear - sign_of_free_shear(status) * grown;
  if (vertical) return {point.shear_x, free_shear, normal};
  return {free_shear, point.shear_y, normal};
}

}  // namespace pillarfield
