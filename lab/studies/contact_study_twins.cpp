#include "lab/studies/contact_study_twins.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "pillarfield/error.h"
#include "simulation/ideal_readings.h"

namespace pillarfield::contact_study {
namespace {

using double_precision::Force;

constexpr double kTwinCountsPerNewton = 320;

/// The force with `normal_share` of the normal force and equal readings of sensels 1 and 4, those
/// that shear to the right loads.
Force twin_of(const Force& force, double normal_share) {
  const double less = (1 - normal_share) * force.normal;
  return {force.shear_x + std::numbers::sqrt2 * less, force.shear_y, force.normal - less};
}

/// Throws Error unless sensels 2 and 3 are inactive.
void check_inactive(const Force& force) {
  const auto v = double_precision::model_readings(force, kTwinCountsPerNewton);
  if (v.v2 <= 0 && v.v3 <= 0) return;
  throw Error("twin scene", "a pillar presses three sensels", "raise the friction");
}

}  // namespace

StudyContact contact_of(const TwinScene& scene) {
  StudyContact contact;
  contact.body.radius = scene.radius;
  contact.tangential = {.motion = Motion::slide, .direction_deg = scene.direction_deg};
  contact.peak_counts = scene.peak_counts;
  return contact;
}

Twins sliding_twins(const TwinScene& scene) {
  const PillarLoads loads = loads_of(contact_of(scene));
  const double per_count = 1 / kTwinCountsPerNewton;
  Twins twins;
  for (std::size_t i = 0; i < loads.normal.size(); ++i) {
    const Force force = {scene.friction * loads.shear_x[i] * per_count,
                         scene.friction * loads.shear_y[i] * per_count,
                         loads.normal[i] * per_count};
    twins.first.push_back(force);
    twins.second.push_back(twin_of(force, scene.normal_share));
    check_inactive(twins.first.back());
    check_inactive(twins.second.back());
  }
  const auto largest =
      std::max_element(twins.second.begin(), twins.second.end(),
                       [](const Force& a, const Force& b) { return a.normal < b.normal; });
  twins.first_friction = scene.friction;
  twins.second_friction = std::hypot(largest->shear_x, largest->shear_y) / largest->normal;
  twins.second_direction_deg =
      std::atan2(largest->shear_y, largest->shear_x) * 180 / std::numbers::pi;
  return twins;
}

std::array<double, 4> readings_counts(const Force& force) {
  const auto v = ideal_readings(force, kTwinCountsPerNewton);
  return {v.v1, v.v2, v.v3, v.v4};
}

double distance_counts(const Force& a, const Force& b) {
  return kTwinCountsPerNewton *
         std::hypot(a.shear_x - b.shear_x, a.shear_y - b.shear_y, a.normal - b.normal);
}

}  // namespace pillarfield::contact_study
