#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// Total force on the skin in one frame. Pillars without load and forces that are not finite count
/// as zero.
struct CurvePoint {
  double time_s = 0;
  std::uint64_t index = 0;                     ///< of the frame
  float shear_x = 0, shear_y = 0, normal = 0;  ///< N
  /// Moment of the shear about the centre of pressure, N mm, counter-clockwise; NaN without load.
  float torque = 0;
  /// Centre of pressure from the middle of the skin, + right and up; NaN without load.
  float centre_x_mm = 0, centre_y_mm = 0;
};

/// Sums a field. Idle blocks of 8 pillars cost one comparison.
[[nodiscard]] CurvePoint curve_point(const ShownField& field, const Pitch& element_pitch_mm);

/// The total force over time. Thread safe.
class Curves {
 public:
  static constexpr std::size_t kMostPoints = std::size_t{1} << 22;

  /// A curve of more than `most_points` loses its first points.
  explicit Curves(const Pitch& element_pitch_mm, std::size_t most_points = kMostPoints);

  /// Appends a frame that is later than the last.
  void add(const ShownField& field) { add(curve_point(field, pitch_mm_)); }
  void add(const CurvePoint& point);

  /// The index after the last frame.
  [[nodiscard]] std::uint64_t next() const;

  /// The times of the first and the last point; equal without points.
  [[nodiscard]] std::pair<double, double> time_span() const;

  /// Points with times in [from_s, to_s] and one more at each side, thinned by
  /// leaving out points evenly to at most `most` + 2; the extremes of the normal force stay.
  [[nodiscard]] std::vector<CurvePoint> between(double from_s, double to_s, std::size_t most) const;

 private:
  Pitch pitch_mm_;
  std::size_t most_points_;
  mutable std::mutex mutex_;  ///< guards the next member
  std::deque<CurvePoint> points_;
};

}  // namespace pillarfield::viewer
