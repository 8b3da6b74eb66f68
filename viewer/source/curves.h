#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <vector>

#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// Total force on a rectangle of pillars in one frame. Pillars without usable sensels and forces
/// that are not finite count as zero.
struct CurvePoint {
  double time_s = 0;
  std::uint64_t index = 0;                     ///< of the frame
  float shear_x = 0, shear_y = 0, normal = 0;  ///< N
  /// Moment of the shear about the centre of pressure, N mm, counter-clockwise; NaN without load.
  float torque = 0;
  float centre_x_mm = 0, centre_y_mm = 0;  ///< centre of pressure; NaN without load
};

/// As sums_over().
[[nodiscard]] CurvePoint curve_point(const ShownField& field, const PillarRect& rect,
                                     const Pitch& element_pitch_mm);

/// Forces over time: a curve for the whole skin, and one for each of further rectangles of pillars.
/// Thread safe.
class Curves {
 public:
  static constexpr std::size_t kMostPoints = std::size_t{1} << 22;

  /// A curve of more than `most_points` loses its first points.
  explicit Curves(const Pitch& element_pitch_mm, std::size_t most_points = kMostPoints);

  /// Sets the further rectangles; those that exist keep their curves, new ones are empty.
  /// Equal rectangles have one curve.
  void set_rects(std::span<const PillarRect> rects);

  /// Appends a frame to each curve whose last frame is earlier.
  void add(const ShownField& field);
  void add_total(const CurvePoint& total);  ///< the same for the curve of the whole skin alone

  /// The least index after the last frame of a curve.
  [[nodiscard]] std::uint64_t next() const;
  /// True if only the curve of the whole skin lacks this frame.
  [[nodiscard]] bool wants_total_alone(std::uint64_t index) const;

  /// The times of the first and the last point of the whole skin; equal without points.
  [[nodiscard]] std::pair<double, double> time_span() const;

  /// Points of the whole skin with times in [from_s, to_s] and one more at each side, thinned by
  /// leaving out points evenly to at most `most` + 2; the extremes of the normal force stay.
  [[nodiscard]] std::vector<CurvePoint> total(double from_s, double to_s, std::size_t most) const;
  /// The same of a further rectangle; empty if it has no curve.
  [[nodiscard]] std::vector<CurvePoint> of(const PillarRect& rect, double from_s, double to_s,
                                           std::size_t most) const;

 private:
  using Points = std::deque<CurvePoint>;
  struct Curve {
    PillarRect rect;
    Points points;
  };
  void append(Points& points, const CurvePoint& point) const;

  Pitch pitch_mm_;
  std::size_t most_points_;
  mutable std::mutex mutex_;  ///< guards the members below
  Points total_;
  std::vector<Curve> curves_;
};

}  // namespace pillarfield::viewer
