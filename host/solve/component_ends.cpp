#include "pillarfield/component_ends.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solve/segment.h"

namespace pillarfield {
namespace {

constexpr double kDeviations95 = 1.96;

struct Interval {
  double low;
  double high;

  [[nodiscard]] Interval wider(double by) const { return {low - by, high + by}; }
};

/// One component of a pillar's force.
struct Component {
  double value = 0;
  double deviation = 0;

  [[nodiscard]] Interval interval() const {
    return Interval{value, value}.wider(kDeviations95 * deviation);
  }
  /// Deviation due to noise, if `other` is due to ambiguity.
  [[nodiscard]] double noise_beside(double other) const {
    return std::sqrt(std::max(deviation * deviation - other * other, 0.0));
  }
};

/// Deviation of a segment's normal force due to ambiguity, N (U9).
double ambiguity_of(double high, double point) {
  constexpr double kPoint = 0.875;
  constexpr double kOfPoint = 0.12;
  return std::hypot(kOfPoint, point - kPoint) * high;
}

/// Intervals of the free shear component and of the normal force on the feasible segment of a
/// direct force at the segment point `point` (F1, F2), N. `sign` is that of the free component,
/// `slope` its decrease per newton.
void set_segment(double point, double sign, double slope, const Component& moving,
                 const Component& normal, Interval& of_moving, Interval& of_normal) {
  const double high = normal.value / point;
  const double ambiguity = ambiguity_of(high, point);
  const double least = sign * moving.value - slope * (high - normal.value);
  const double most = sign * moving.value + slope * normal.value;
  const double noise = moving.noise_beside(slope * ambiguity);
  of_moving = sign < 0 ? Interval{-most, -least} : Interval{least, most};
  of_moving = of_moving.wider(kDeviations95 * noise);
  of_normal = {0, high + kDeviations95 * normal.noise_beside(ambiguity)};
}

}  // namespace

std::array<float, kComponentEnds> component_ends(const ForceFieldView& forces, std::size_t pillar,
                                                 const std::optional<double>& direct_point,
                                                 const ShearCoefficient& coefficient) {
  const auto component = [&](std::span<const float> values, Uncertainty deviation) {
    if (values.empty()) return Component{};  // without pillars
    return Component{values[pillar], forces.uncertainty[deviation][pillar]};
  };
  const Component x = component(forces.shear_x, Uncertainty::shear_x);
  const Component y = component(forces.shear_y, Uncertainty::shear_y);
  const Component normal = component(forces.normal, Uncertainty::normal);
  Interval of_x = x.interval();
  Interval of_y = y.interval();
  Interval of_normal = normal.interval();
  const std::uint8_t status = forces.status[pillar];
  if (direct_point && has_feasible_segment(status) && normal.value > 0) {
    const bool vertical = shear_y_is_free(status);
    const double slope = std::numbers::sqrt2 / (vertical ? coefficient.y : coefficient.x);
    set_segment(*direct_point, sign_of_free_shear(status), slope, vertical ? y : x, normal,
                vertical ? of_y : of_x, of_normal);
  }
  if (normal.value >= 0) of_normal.low = std::max(of_normal.low, 0.0);
  const auto number = [](double value) { return static_cast<float>(value); };
  return {number(of_x.low),  number(of_x.high),     number(of_y.low),
          number(of_y.high), number(of_normal.low), number(of_normal.high)};
}

}  // namespace pillarfield
