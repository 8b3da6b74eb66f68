#pragma once

#include <vector>

/// Study of the errors that a dead zone causes in small forces, with and without its calibration.
namespace pillarfield::small_forces_study {

/// Fractions of forces and errors over all directions of the hemisphere.
struct SmallForceErrors {
  double undetected;    ///< fraction without any usable sensel
  double wrong_region;  ///< fraction in another region than in the ideal model
  double unflagged;     ///< fraction in a wrong region without a status bit
  double force;         ///< RMS of |solved − true| / |true|
  double theta_rad;     ///< RMS
  double phi_rad;       ///< RMS, weighted with sin(theta)
  double determined;    ///< `force` over forces with three or four usable sensels
  double held;          ///< fraction with the truth inside the intervals (see Coverage)
};

/// Forces of one magnitude.
struct SmallForcePoint {
  double load;              ///< F k / z: counts of a normal force over the dead zone
  SmallForceErrors paper;   ///< the paper's equations, without dead zone and intervals
  SmallForceErrors naive;   ///< the direct solve without the dead zone
  SmallForceErrors direct;  ///< the direct solve with the dead zone
};

/// Number of directions of each magnitude.
inline constexpr int kStudyDirections = 4096;

/// The sensor of the study; k is the default of Skin.
inline constexpr double kStudyDeadZoneCounts = 20;
inline constexpr double kStudyNoiseCounts = 0.5;
inline constexpr double kStudyThresholdCounts = 3;

/// Solves loads from 0.3 to 100 in directions spread evenly over the hemisphere, in about 0.1 s.
[[nodiscard]] std::vector<SmallForcePoint> small_forces();

}  // namespace pillarfield::small_forces_study
