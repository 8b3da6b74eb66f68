#pragma once

#include <array>
#include <cstdint>

#include "solve/one_pillar.h"

/// Lower bound of the error under noise, and the error of an estimator (docs/derivations/bound.md).
/// A sensel reads max(0, V) and noise of `noise_counts`; it is usable above `threshold_counts`.
/// Dead zone and full scale are left aside.
namespace pillarfield::bound {

using Force = double_precision::Force;

/// The force of `magnitude_n` that comes from (theta, phi), radians (M2).
[[nodiscard]] Force force_from(double magnitude_n, double theta_rad, double phi_rad);

/// Fisher information of a reading about its V, over that without a threshold, for V `deviations`
/// standard deviations above the threshold (B2).
[[nodiscard]] double information(double deviations);

/// The Cramér–Rao bound: the least RMS of |estimate − force| of unbiased estimates, N (B3).
[[nodiscard]] double least_error(Force force, const PillarSensor& sensor);

/// The sensels 1 to 4 of a pillar where they are not alike, but for their counts per newton.
using Sensels = std::array<PillarSensor, 4>;
[[nodiscard]] double least_error(Force force, const Sensels& sensels);

/// True if every V is `deviations` standard deviations or more above the threshold or below.
[[nodiscard]] bool is_far_from_borders(Force force, const PillarSensor& sensor, double deviations);
[[nodiscard]] bool is_far_from_borders(Force force, const Sensels& sensels, double deviations);

/// Number of sensels that read above the threshold when there is no noise.
[[nodiscard]] int usable_sensels(Force force, const PillarSensor& sensor);
[[nodiscard]] int usable_sensels(Force force, const Sensels& sensels);

/// RMS of |estimate − force| over random readings, N.
struct RmsError {
  double of_all = 0;
  double of_rightly_read = 0;  ///< where noise made no other sensels usable than there should be
  double misread_share = 0;    ///< of the rest
};

/// Draws `draws` times four readings. The standard error of the second figure is at most
/// 0.7 / sqrt(draws) of it; that of the first may be larger, as rare misreadings count much.
/// `number` seeds the noise. About 0.5 µs a draw.
[[nodiscard]] RmsError rms_error(Force force, const PillarSensor& sensor, Estimator estimator,
                                 int draws, std::uint64_t number);

}  // namespace pillarfield::bound
