#pragma once

#include <vector>

/// How much a dead zone spoils small forces, and how much of it a solve that knows of it mends.
namespace pillarfield::testbed {

/// Shares and errors over all directions of the hemisphere.
struct SmallForceErrors {
  double unfelt;        ///< share of the forces of which no sensel answers
  double wrong_region;  ///< share felt, in another region than in the ideal model
  double unflagged;     ///< share felt, in a wrong region, and no status bit says that it may be
  double force;         ///< RMS of |solved − true| / |true|
  double theta_rad;     ///< RMS
  double phi_rad;       ///< RMS, weighted with sin(theta)
  double determined;    ///< `force` of those alone that leave three or four sensels usable
  double held;          ///< share whose truth lies between the stated ends (see Coverage)
};

/// Forces of one magnitude.
struct SmallForcePoint {
  double load;              ///< F k / z: counts of a normal force over those of the dead zone
  SmallForceErrors paper;   ///< the paper's equations, which know of no dead zone; states no ends
  SmallForceErrors naive;   ///< the direct solve, not told of the dead zone
  SmallForceErrors direct;  ///< the direct solve with it
};

/// Directions of each magnitude.
inline constexpr int kStudyDirections = 4096;

/// The sensor of the study; k is the default of Skin.
inline constexpr double kStudyDeadZoneCounts = 20;
inline constexpr double kStudyNoiseCounts = 0.5;
inline constexpr double kStudyThresholdCounts = 3;

/// Loads from 0.3 to 100, each with forces from directions spread evenly over the
/// hemisphere and solved as whole frames. Some 0.1 s.
[[nodiscard]] std::vector<SmallForcePoint> small_forces();

}  // namespace pillarfield::testbed
