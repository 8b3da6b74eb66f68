#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solve/one_pillar.h"
#include "solve/pillar_maths.h"

/// Simulation of the paper's testbed (sections IV and V): a probe presses one pillar from three
/// directions with 10 to 100 N (docs/testbed.md).
namespace pillarfield::testbed {

using Force = double_precision::Force;
using Estimate = PillarEstimate<double>;

/// A direction of Table II, from which the probe presses.
struct Site {
  const char* name;
  double phi_rad;
  double theta_rad;
};

inline constexpr std::array<Site, 3> kSites = {{
    {"Region 1", 2.094, 0.471},
    {"Region 2", 3.927, 0.977},
    {"Region 3", 5.760, 1.222},
}};

/// Applied forces at each site, as the probe reads them.
inline constexpr std::array<double, 10> kAppliedN = {10, 20, 30, 40, 50, 60, 70, 80, 90, 100};

/// Constants of the testbed. The paper states those of the probe; those of the sensor are chosen.
struct Parameters {
  /// 12 bits cover 100 N from every site. The dead zone of 7.2 N (144 counts) fits the scatter in
  /// region 1 best (scan_dead_zones()). The threshold is six times the noise.
  PillarSensor sensor = {.counts_per_newton = 20,
                         .threshold_counts = 3,
                         .dead_zone_counts = 144,
                         .full_scale_counts = 4095,
                         .noise_counts = 0.5};
  double positioner_rad = 0.04;     ///< largest error of a site's angles, uniform
  double play_rad = 0.01;           ///< largest further rotation at 100 N, uniform
  double probe_resolution_n = 0.1;  ///< the force differs by at most half of this
  std::uint64_t seed = 1;
};

/// Throws Error where a parameter is out of range.
void check(const Parameters& parameters);

/// Uncertainty of the angles of a site: positioner plus play, 0.05 rad as in the paper.
[[nodiscard]] double angle_uncertainty_rad(const Parameters& parameters);

/// An applied force and its estimates.
struct Trial {
  double applied_n;           ///< as the probe reads it
  Force truth;                ///< N
  std::array<double, 4> raw;  ///< counts, sensels 1 to 4
  Estimate paper;             ///< by the paper's equations, without dead zone
  Estimate direct;            ///< by the direct solve with calibrated dead zone
};

/// Trials of one site, in the order of kAppliedN.
using Series = std::array<Trial, kAppliedN.size()>;

/// One run of the experiment: a series for each site.
using Experiment = std::array<Series, kSites.size()>;

/// Returns run `number`, a function of the parameters and this number. Runs with different numbers
/// are independent. Takes about 15 µs.
[[nodiscard]] Experiment run_experiment(const Parameters& parameters, std::uint64_t number);

/// Returns the force on the skin from (theta, phi) (docs/derivations/pillar_model.md, M2).
[[nodiscard]] Force force_from(double magnitude_n, double theta_rad, double phi_rad);

/// Returns the brackets of equation (2): readings of sensels 1 to 4 for 1 N from (theta, phi) and k
/// = 1, negative under tension.
[[nodiscard]] std::array<double, 4> brackets(double theta_rad, double phi_rad);

/// Returns raw readings after dead zone, noise (four standard normal variates) and converter.
[[nodiscard]] std::array<double, 4> read_sensels(Force force, const PillarSensor& sensor,
                                                 std::span<const float, 4> noise);

/// Returns the sensor without dead zone and noise, as for the paper's estimator.
[[nodiscard]] PillarSensor without_calibration(PillarSensor sensor);

/// Returns `angle_rad` plus the whole turns that bring it nearest to `centre_rad`.
[[nodiscard]] double unwrapped(double angle_rad, double centre_rad);

}  // namespace pillarfield::testbed
