#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pillarfield/solver_plan.h"

/// Lower bound of the error under noise, and the error of an estimator (docs/derivations/bound.md).
/// A sensel reads max(0, V) and noise of `noise_counts`; it is usable above `threshold_counts`.
/// Dead zone and full scale are left aside.
namespace pillarfield::bound {

/// Newtons, as in ForceField.
struct Force {
  double shear_x = 0;
  double shear_y = 0;
  double normal = 0;
};

/// The sensor of a pillar.
struct PillarSensor {
  double counts_per_newton = 1;
  double threshold_counts = 0;
  double noise_counts = 0;  ///< standard deviation
};

/// V of the sensels 1 to 4, counts; negative where one is inactive (M3).
[[nodiscard]] std::array<double, 4> model_readings(Force force, double counts_per_newton);

/// Place of sensel 0..3 of a pillar in a frame that is `pillar_cols` pillars wide.
[[nodiscard]] std::size_t place_of(std::size_t pillar, std::size_t sensel, std::size_t pillar_cols);

/// The bits of sensels whose V is above `counts`, as in status bytes.
[[nodiscard]] std::uint8_t bits_above(const std::array<double, 4>& v, double counts);

/// The force of `magnitude_n` that comes from (theta, phi), radians (M2).
[[nodiscard]] Force force_from(double magnitude_n, double theta_rad, double phi_rad);

/// Fisher information of a reading about its V, over that without a threshold, for V `deviations`
/// standard deviations above the threshold (B2).
[[nodiscard]] double information(double deviations);

/// The Cramér–Rao bound: the least RMS of |estimate − force| of unbiased estimates, N (B3).
[[nodiscard]] double least_error(Force force, const PillarSensor& sensor);

/// True if every V is `deviations` standard deviations or more above the threshold or below.
[[nodiscard]] bool is_far_from_borders(Force force, const PillarSensor& sensor, double deviations);

/// Number of sensels that read above the threshold when there is no noise.
[[nodiscard]] int usable_sensels(Force force, const PillarSensor& sensor);

/// RMS of |estimate − force| over random readings, N.
struct RmsError {
  double of_all = 0;
  double of_rightly_read = 0;  ///< where noise made no other sensels usable than there should be
  double misread_share = 0;    ///< of the rest
};

/// Draws four readings `draws` times, a multiple of 100, and solves them on the host. The standard
/// error of the second figure is at most 0.7 / sqrt(draws) of it; that of the first may be larger,
/// as rare misreadings count much. `number` seeds the noise. About 0.1 µs a draw.
[[nodiscard]] RmsError rms_error(Force force, const PillarSensor& sensor, Estimator estimator,
                                 int draws, std::uint64_t number);

}  // namespace pillarfield::bound
