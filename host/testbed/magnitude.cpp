#include "testbed/magnitude.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "pillarfield/status.h"

namespace pillarfield::testbed {
namespace {

/// Least-squares magnitude of equation (2) for `readings` (k = 1) and the brackets `assumed`.
double fitted_magnitude(const std::array<double, 4>& readings,
                        const std::array<double, 4>& assumed) {
  double product = 0;
  double square = 0;
  for (std::size_t n = 0; n < assumed.size(); ++n) {
    if (readings[n] <= 0) continue;
    product += readings[n] * assumed[n];
    square += assumed[n] * assumed[n];
  }
  return product / square;
}

MagnitudePoint point_of(const Trial& trial, MagnitudeBand band) {
  const auto& interval = trial.direct.interval;
  return {trial.applied_n,
          {trial.applied_n * band.low, trial.applied_n * band.high},
          trial.paper.direction.magnitude,
          trial.direct.direction.magnitude,
          {interval.magnitude_low, interval.magnitude_high},
          (trial.direct.status & status::kAmbiguous) != 0};
}

}  // namespace

MagnitudeBand magnitude_band(const Site& site, double uncertainty_rad) {
  constexpr int kSteps = 20;
  const std::array<double, 4> readings = brackets(site.theta_rad, site.phi_rad);
  MagnitudeBand band = {std::numeric_limits<double>::infinity(), 0};
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const double fitted =
          fitted_magnitude(readings, brackets(site.theta_rad + uncertainty_rad * i / kSteps,
                                              site.phi_rad + uncertainty_rad * j / kSteps));
      band.low = std::min(band.low, fitted);
      band.high = std::max(band.high, fitted);
    }
  }
  return band;
}

MagnitudeFigure magnitude_figure(const Parameters& parameters) {
  const Experiment run = run_experiment(parameters, 0);
  MagnitudeFigure figure{};
  for (std::size_t site = 0; site < figure.size(); ++site) {
    const MagnitudeBand band = magnitude_band(kSites[site], angle_uncertainty_rad(parameters));
    std::transform(run[site].begin(), run[site].end(), figure[site].begin(),
                   [&](const Trial& trial) { return point_of(trial, band); });
  }
  return figure;
}

}  // namespace pillarfield::testbed
