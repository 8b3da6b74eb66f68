#pragma once

#include <array>
#include <vector>

#include "evaluation/closed_form_contacts.h"
#include "solve/pillar_maths.h"

/// Two bodies that no estimator can tell from each other.
namespace pillarfield::contact_study {

struct TwinScene {
  double radius = 30;  ///< of a sphere's contact, pitches
  double peak_counts = 100;
  double friction = 1.6;
  double direction_deg = 3;
  double normal_share = 0.7;  ///< the second's normal force over the first's
};

/// The first body.
[[nodiscard]] StudyContact contact_of(const TwinScene& scene);

/// Forces of both bodies on every pillar; they slide all over.
struct Twins {
  std::vector<double_precision::Force> first;  ///< N; row by row
  std::vector<double_precision::Force> second;
  double first_friction = 0;
  double second_friction = 0;
  double second_direction_deg = 0;
};

/// The second body presses everywhere with `normal_share` of the first's pressure, and slides in a
/// direction and at a friction of its own, so that each pillar's two pressed sensels read the same,
/// and the other two nothing. Both pressures are Hertz's. The direction lies within 45° of +x.
/// Throws Error where there is no such body: where one of the two would press a third sensel.
[[nodiscard]] Twins sliding_twins(const TwinScene& scene);

/// What a flawless sensor reads, sensels 1 to 4, counts; nothing where a pillar lifts.
[[nodiscard]] std::array<double, 4> readings_counts(const double_precision::Force& force);

[[nodiscard]] double distance_counts(const double_precision::Force& a,
                                     const double_precision::Force& b);

}  // namespace pillarfield::contact_study
