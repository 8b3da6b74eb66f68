#pragma once

// The forces between which the readings of an ambiguous pillar leave the choice: a segment along
// which the normal force is free (docs/derivations/segment.md). For two adjacent usable sensels.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "pillarfield/status.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// Whether the shear's y component is the one that changes along the segment: the usable sensels
/// are the upper or the lower two.
[[nodiscard]] inline bool moves_vertically(std::uint8_t status) {
  const int usable = status & status::kUsable;
  return usable == 3 || usable == 12;
}

/// One component of the shear is fixed; the other shrinks as the normal force grows, from `moving`
/// where that is zero, by sqrt(2) of it.
struct Segment {
  float fixed;   ///< size of the one component, N
  float moving;  ///< size of the other without normal force, N
  float high;    ///< largest normal force, N; the least is zero

  /// Shear over normal force where the normal force, above zero, is this.
  [[nodiscard]] double ratio_at(double normal) const {
    const double rest = std::max(moving - std::numbers::sqrt2 * normal, 0.0);
    return std::sqrt(double{fixed} * fixed + rest * rest) / normal;
  }
};

/// How the largest normal force of a segment is known (F1).
struct SegmentEnd {
  float point = 0;     ///< of direct forces, SolverPlan::segment_point; 0: of any on the segment
  float hidden_n = 0;  ///< else: the normal force that sensels hide at the threshold, N
};

/// The segment on which a force lies (F1, F2).
[[nodiscard]] inline Segment segment_of(const single_precision::Force& point, bool vertical,
                                        const SegmentEnd& end) {
  constexpr float kRoot2 = std::numbers::sqrt2_v<float>;
  const float fixed = std::abs(vertical ? point.shear_x : point.shear_y);
  const float moving = std::abs(vertical ? point.shear_y : point.shear_x) + kRoot2 * point.normal;
  const float high = end.point > 0 ? point.normal / end.point
                                   : std::max(moving - fixed, 0.0F) / (2 * kRoot2) + end.hidden_n;
  return {fixed, moving, high};
}

/// The force whose normal force is `normal`, of the segment on which `point` lies (F2).
[[nodiscard]] inline single_precision::Force force_on_segment(const single_precision::Force& point,
                                                              bool vertical, float normal) {
  const float grown = std::numbers::sqrt2_v<float> * (normal - point.normal);
  const float moved = vertical ? point.shear_y : point.shear_x;
  const float moving = moved - std::copysign(1.0F, moved) * grown;
  if (vertical) return {point.shear_x, moving, normal};
  return {moving, point.shear_y, normal};
}

}  // namespace pillarfield
