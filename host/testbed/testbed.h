#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solve/one_pillar.h"
#include "solve/pillar_maths.h"

/// The testbed of the paper (its sections IV and V), simulated: one pillar on four sensors, and a
/// probe that presses from three directions with 10 to 100 N (docs/testbed.md).
namespace pillarfield::testbed {

using Force = double_precision::Force;
using Estimate = PillarEstimate<double>;

/// One of the three directions of the paper's Table II, from which the probe presses.
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

/// The forces that are applied at each site, by the probe's reading.
inline constexpr std::array<double, 10> kAppliedN = {10, 20, 30, 40, 50, 60, 70, 80, 90, 100};

/// What the paper states of its testbed, and what had to be chosen because it does not: the
/// constants of the sensor. One set for all sites and forces.
struct Parameters {
  /// Chosen: 20 counts per newton and 12 bits hold 100 N from every site; the dead zone of 7.2 N
  /// (144 counts) is the one that comes nearest to the scatter in region 1 (table_two.h); noise of
  /// half a count, and a threshold of six times that.
  PillarSensor sensor = {.counts_per_newton = 20,
                         .threshold_counts = 3,
                         .dead_zone_counts = 144,
                         .full_scale_counts = 4095,
                         .noise_counts = 0.5};
  double positioner_rad = 0.04;     ///< a site's angles are off by at most this, evenly spread
  double play_rad = 0.01;           ///< and turn by at most this more as the force rises to 100 N
  double probe_resolution_n = 0.1;  ///< the force is what the probe reads, to half of this
  std::uint64_t seed = 1;
};

/// Throws Error, its place being the option of `pillarfield testbed`, when a parameter is out of
/// its range.
void check(const Parameters& parameters);

/// What the angles of a site are uncertain by: positioner and play, 0.05 rad as in the paper.
[[nodiscard]] double angle_uncertainty_rad(const Parameters& parameters);

/// One force, applied and measured.
struct Trial {
  double applied_n;           ///< by the probe
  Force truth;                ///< N, what really acts
  std::array<double, 4> raw;  ///< counts, sensels 1 to 4
  Estimate paper;             ///< by the paper's equations, which know of no dead zone
  Estimate direct;            ///< by the direct solve, whose dead zone is calibrated
};

/// The trials of one site, in the order of kAppliedN.
using Series = std::array<Trial, kAppliedN.size()>;

/// The experiment once: a series for each site. Runs with different numbers are independent.
using Experiment = std::array<Series, kSites.size()>;

/// Run `number` of the experiment; it depends on the parameters and this number only. Some 15 µs.
[[nodiscard]] Experiment run_experiment(const Parameters& parameters, std::uint64_t number);

/// The force on the skin that comes from (theta, phi) (docs/derivations/pillar_model.md, M2).
[[nodiscard]] Force force_from(double magnitude_n, double theta_rad, double phi_rad);

/// What sensels 1 to 4 of a pillar with k = 1 count per newton read of 1 N from (theta, phi),
/// negative where it lifts: the bracket of equation (2).
[[nodiscard]] std::array<double, 4> brackets(double theta_rad, double phi_rad);

/// What the sensels read of a force: dead zone, noise (four standard normal variates), converter.
[[nodiscard]] std::array<double, 4> read_sensels(Force force, const PillarSensor& sensor,
                                                 std::span<const float, 4> noise);

/// What the paper's estimator knows of a sensor: nothing of its dead zone and noise.
[[nodiscard]] PillarSensor without_calibration(PillarSensor sensor);

/// `angle_rad` as the one of its equals, whole turns apart, that is nearest to `centre_rad`.
[[nodiscard]] double unwrapped(double angle_rad, double centre_rad);

}  // namespace pillarfield::testbed
