#include "calibration/common_response.h"

#include <cmath>
#include <cstddef>

#include "calibration/golden_section.h"

namespace pillarfield {
namespace {

/// Least number of forces from which a dead zone is fitted beside an exponent and a factor.
constexpr std::size_t kLeastForDeadZone = 4;
/// Largest fitted dead zone as a fraction of the smallest force.
constexpr double kMostDeadZone = 0.98;

/// Sum of squared distances of log(force − dead zone) from the line in log(reading) nearest to it.
double misfit_of_line(const std::vector<double>& forces_n, const std::vector<double>& readings,
                      double dead_zone_n) {
  const auto count = static_cast<double>(forces_n.size());
  double x = 0;
  double y = 0;
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (std::size_t i = 0; i < forces_n.size(); ++i) {
    // Relative to the first reading and force, which keeps the sums small.
    const double log_reading = std::log(readings[i] / readings[0]);
    const double log_force = std::log((forces_n[i] - dead_zone_n) / forces_n[0]);
    x += log_reading;
    y += log_force;
    xx += log_reading * log_reading;
    xy += log_reading * log_force;
    yy += log_force * log_force;
  }
  const double covariance = xy - x * y / count;
  return yy - y * y / count - covariance * covariance / (xx - x * x / count);
}

double fit_dead_zone(const std::vector<double>& forces_n, const std::vector<double>& readings) {
  if (forces_n.size() < kLeastForDeadZone) return 0;
  const auto misfit = [&](double zone) { return misfit_of_line(forces_n, readings, zone); };
  const double most = kMostDeadZone * forces_n[0];
  const double zone = least_of(misfit, 0, most, 1e-6 * forces_n[0]);
  return misfit(zone) < misfit(0) ? zone : 0;
}

/// Adds a knot at `factor` times the reading of `knot`, on the power law through it and `other`.
void continue_curve(ResponseCurve& curve, std::size_t knot, std::size_t other, double factor,
                    std::size_t place) {
  const double exponent = std::log(curve.loads[other] / curve.loads[knot]) /
                          std::log(curve.readings[other] / curve.readings[knot]);
  const auto offset = static_cast<std::ptrdiff_t>(place);
  const double reading = factor * curve.readings[knot];
  const double load = std::pow(factor, exponent) * curve.loads[knot];
  curve.readings.insert(curve.readings.begin() + offset, reading);
  curve.loads.insert(curve.loads.begin() + offset, load);
}

}  // namespace

CommonResponse fit_common_response(const std::vector<double>& forces_n,
                                   const std::vector<double>& readings) {
  CommonResponse response;
  response.dead_zone_n = fit_dead_zone(forces_n, readings);
  ResponseCurve& curve = response.curve;
  curve.readings = readings;
  for (const double force_n : forces_n) curve.loads.push_back(force_n - response.dead_zone_n);
  const std::size_t last = readings.size() - 1;
  continue_curve(curve, last, last - 1, 1.5, last + 1);
  continue_curve(curve, 0, 1, 1.0 / 4, 0);
  continue_curve(curve, 0, 1, 1.0 / 4, 0);
  return response;
}

}  // namespace pillarfield
