#pragma once

// The feasible segment of an ambiguous pillar with two adjacent usable sensels: all forces that are
// consistent with its readings (docs/derivations/segment.md).

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "pillarfield/status.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// True if shear_y, not shear_x, varies along the segment: the usable sensels are the upper or the
/// lower two.
[[nodiscard]] inline bool shear_y_is_free(std::uint8_t status) {
  const int usable = status & status::kUsable;
  return usable == 3 || usable == 12;
}

/// A segment of forces. One shear component is known; the other is free: it falls from `free_shear`
/// at zero normal force by sqrt(2) times the normal force.
struct FeasibleSegment {
  float known_shear;  ///< magnitude of the known component, N
  float free_shear;   ///< magnitude of the free component at zero normal force, N
  float high;         ///< largest normal force, N; the least is zero

  /// Shear over normal force at the normal force `normal` > 0, N.
  [[nodiscard]] double ratio_at(double normal) const {
    const double rest = std::max(free_shear - std::numbers::sqrt2 * normal, 0.0);
    return std::sqrt(double{known_shear} * known_shear + rest * rest) / normal;
  }
};

/// Source of a segment's largest normal force (F1).
struct SegmentEnd {
  float point = 0;     ///< segment point of a direct force; 0: the force is anywhere on the segment
  float hidden_n = 0;  ///< normal force below the threshold, N, if `point` is 0
};

/// The feasible segment through a force (F1, F2).
[[nodiscard]] inline FeasibleSegment segment_of(const single_precision::Force& point, bool vertical,
                                                const SegmentEnd& end) {
  constexpr float kRoot2 = std::numbers::sqrt2_v<float>;
  const float known_shear = std::abs(vertical ? point.shear_x : point.shear_y);
  const float free_shear =
      std::abs(vertical ? point.shear_y : point.shear_x) + kRoot2 * point.normal;
  const float high = end.point > 0
                         ? point.normal / end.point
                         : std::max(free_shear - known_shear, 0.0F) / (2 * kRoot2) + end.hidden_n;
  return {known_shear, free_shear, high};
}

/// The force with the normal force `normal`, N, on the segment through `point` (F2).
[[nodiscard]] inline single_precision::Force force_on_segment(const single_precision::Force& point,
                                                              bool vertical, float normal) {
  const float grown = std::numbers::sqrt2_v<float> * (normal - point.normal);
  const float shear = vertical ? point.shear_y : point.shear_x;
  const float free_shear = shear - std::copysign(1.0F, shear) * grown;
  if (vertical) return {point.shear_x, free_shear, normal};
  return {free_shear, point.shear_y, normal};
}

}  // namespace pillarfield
