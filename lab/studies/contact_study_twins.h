#pragma once

#include <array>
#include <vector>

#include "lab/studies/closed_form_contacts.h"
#include "solve/pillar_maths.h"

/// Two bodies with equal readings, which no estimator can distinguish.
namespace pillarfield::contact_study {

struct TwinScene {
  double radius = 30;  ///< contact radius of a sphere, pitches
  double peak_counts = 100;
  double friction = 1.6;
  double direction_deg = 3;
  double normal_share = 0.7;  ///< normal force of the second over that of the first
};

/// The first body.
[[nodiscard]] StudyContact contact_of(const TwinScene& scene);

/// Forces of both bodies, in full sliding, on every pillar.
struct Twins {
  std::vector<double_precision::Force> first;  ///< N; row by row
  std::vector<double_precision::Force> second;
  double first_friction = 0;
  double second_friction = 0;
  double second_direction_deg = 0;
};

/// The second body has `normal_share` of the first's Hertzian pressure, and the direction (within
/// 45° of +x) and friction for which the two usable sensels of each pillar read as under the first.
/// Throws Error if a third sensel would be loaded.
[[nodiscard]] Twins sliding_twins(const TwinScene& scene);

/// Readings of a flawless sensor, sensels 1 to 4, counts; zero where V is negative.
[[nodiscard]] std::array<double, 4> readings_counts(const double_precision::Force& force);

[[nodiscard]] double distance_counts(const double_precision::Force& a,
                                     const double_precision::Force& b);

}  // namespace pillarfield::contact_study
