#include "testbed/curves.h"

#include <cstddef>

namespace pillarfield::testbed {
namespace {

namespace maths = double_precision;

/// Raw readings of a pillar in region 3.12 with V3 / V4 = `ratio`.
std::array<double, 4> raw_readings(double ratio) { return {0, 0, ratio, 1}; }

Estimate estimate(double ratio, Estimator estimator) {
  return estimate_pillar(raw_readings(ratio), PillarSensor{}, estimator);
}

Angles angles_of(maths::Direction direction) {
  return {direction.theta, unwrapped(direction.phi, kPi / 2)};
}

}  // namespace

double border_theta(int sensel, double phi_rad) {
  const auto reading = [&](double theta) {
    return brackets(theta, phi_rad).at(static_cast<std::size_t>(sensel - 1));
  };
  double usable = 0;
  double inactive = kPi / 2;
  if (reading(inactive) > 0) return inactive;
  for (int step = 0; step < 60; ++step) {
    const double middle = (usable + inactive) / 2;
    (reading(middle) > 0 ? usable : inactive) = middle;
  }
  return inactive;
}

std::vector<Angles> contour(double ratio, int points) {
  const PillarSensor sensor;
  const std::array<double, 4> raw = raw_readings(ratio);
  const maths::Diagonals diagonals =
      maths::pillar_diagonals({prepare_sensel(raw[0], sensor), prepare_sensel(raw[1], sensor),
                               prepare_sensel(raw[2], sensor), prepare_sensel(raw[3], sensor)});
  const maths::ParitySum sum = maths::parity_sum(diagonals, kSegmentPoint);
  const ForceScale scale = force_scale(sensor.counts_per_newton);
  std::vector<Angles> contour;
  for (int i = 0; i < points; ++i) {
    const double parity_sum = sum.low + (sum.high - sum.low) * i / (points - 1);
    const maths::Force force = maths::force_at(diagonals, parity_sum, {scale.shear, scale.normal});
    contour.push_back(angles_of(maths::direction_of(force)));
  }
  return contour;
}

Angles point_on_contour(double ratio, Estimator estimator) {
  return angles_of(estimate(ratio, estimator).direction);
}

Angles half_widths(double ratio) {
  const auto interval = estimate(ratio, Estimator::direct).interval;
  return {(interval.theta_high - interval.theta_low) / 2,
          (interval.phi_high - interval.phi_low) / 2};
}

}  // namespace pillarfield::testbed
