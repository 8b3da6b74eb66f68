#include "simulation/scene/scene_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "pillarfield/error.h"
#include "simulation/body/body_path.h"
#include "simulation/closed_form/direction_sweep.h"
#include "simulation/effects/known_effects.h"
#include "simulation/effects/memory_history.h"

namespace pillarfield {
namespace {

void check_range(const std::string& where, std::string_view key, double value, const Range& range) {
  if (range.contains(value)) return;
  throw Error(where, fmt::format("{} is {}", key, value),
              fmt::format("it must be {}", range.text()));
}

template <class Key>
void check_times(const std::vector<Key>& path, const std::string& where) {
  if (path.empty()) throw Error(where, "path is empty", "it needs a key at least");
  for (std::size_t i = 0; i < path.size(); ++i) {
    check_range(where, "time_s", path[i].time_s, kPathTimeS);
    if (i == 0 || path[i].time_s > path[i - 1].time_s) continue;
    throw Error(where, fmt::format("time_s is {} after {}", path[i].time_s, path[i - 1].time_s),
                "times must rise");
  }
}

template <class Key>
void check_path(const std::vector<Key>& path, const std::string& where) {
  check_times(path, where);
  for (const Key& key : path) {
    check_range(where, "x_mm", key.x_mm, kPathPositionMm);
    check_range(where, "y_mm", key.y_mm, kPathPositionMm);
    check_range(where, "load_n", key.load_n, kPathLoadN);
  }
}

void check_effects(const SensorModel& sensor, const Skin& skin, const std::string& where) {
  if (sensor.hysteresis_range_counts) {
    check_range(where, "hysteresis_range_counts", *sensor.hysteresis_range_counts,
                kHysteresisRangeCounts);
  }
  if (sensor.wires) {
    for (const auto& [key, member, range] : kWireQuantities) {
      check_range(where, key, (*sensor.wires).*member, range);
    }
  }
  if (MemoryHistory::is_needed(sensor) && skin.sensels() > kMaxMemorySensels) {
    throw Error(where, fmt::format("the skin has {} sensels", skin.sensels()),
                fmt::format("with hysteresis or creep it may have {}", kMaxMemorySensels));
  }
  if (!sensor.response_curve.empty() && skin.power_law) {
    throw Error(where, "the sensor has a response curve and a power law", "leave one of them out");
  }
  check(known_effects(sensor, skin), where);
}

void check_bending(const Bending& bending, const std::string& where) {
  check_range(where, "bend_spread_counts_mm", bending.spread_counts_mm, kBendSpread);
  check_times(bending.path, where);
  for (const CurvatureKey& key : bending.path) {
    for (const double value : {key.x, key.y, key.xy}) {
      check_range(where, "curvature_per_mm", value, kCurvaturePerMm);
    }
  }
}

void check_sensor(const SensorModel& sensor, const Skin& skin, const std::string& where) {
  for (const auto& [key, member, range] : kSensorQuantities) {
    check_range(where, key, sensor.*member, range);
  }
  check_effects(sensor, skin, where);
  if (!sensor.adc_bits) return;
  check_range(where, "adc_bits", *sensor.adc_bits, {1, kMaxAdcBits});
  const double largest = *full_scale_of(sensor);
  const double full_scale = skin.full_scale_counts.value_or(largest);
  if (full_scale <= largest && full_scale == std::floor(full_scale)) return;
  throw Error(where, fmt::format("full_scale_counts is {}", full_scale),
              fmt::format("with adc_bits = {} it must be a whole number up to {}", *sensor.adc_bits,
                          largest));
}

void check_contact(const Contact& contact, const std::string& where) {
  if (!is_possible(contact.shape, contact.motion)) {
    throw Error(where, "this shape does not move so", "see docs/scenes.md for what goes together");
  }
  for (const auto& [quantity, required, applies] : kContactQuantities) {
    if (!applies(contact.shape, contact.motion)) continue;
    check_range(where, quantity.key, contact.*quantity.member, quantity.range);
  }
  check_path(contact.path, where);
}

void check_edge(const Body& body, const std::string& where) {
  const double most = body.shape == BodyShape::cylinder ? body.length_mm / 2 : body.radius_mm;
  if (body.edge_radius_mm <= most) return;
  throw Error(
      where, fmt::format("edge_radius_mm is {}", body.edge_radius_mm),
      body.shape == BodyShape::cylinder ? "it may be half of length_mm" : "it may be radius_mm");
}

void check_height_map(const Body& body, const Skin& skin, const std::string& where) {
  if (body.height_map.empty()) throw Error(where, "height_map is missing", "name a file");
  const double most_mm = (kMaxContactPillars - 1) * skin.pillar_pitch_mm();
  for (const double size : body.height_map_size_mm) {
    check_range(where, "height_map_size_mm", size, kBodySizeMm);
    if (size <= most_mm) continue;
    throw Error(where, fmt::format("height_map_size_mm is {}", size),
                fmt::format("on this skin it may be {:.6g}", most_mm));
  }
}

void check_steps(const Body& body, const Scene& scene, const std::string& where) {
  check_range(where, "substeps", body.substeps, {1, kMaxSubsteps});
  const double steps = steps_of(body, scene.rate_hz, scene.frames);
  if (steps <= static_cast<double>(kMaxBodySteps)) return;
  throw Error(
      where, fmt::format("it takes {:.0f} steps", steps),
      fmt::format("its path may have {}: fewer frames, substeps or seconds", kMaxBodySteps));
}

void check_body(const Body& body, const Scene& scene, const std::string& where) {
  for (const auto& [quantity, required, applies] : kBodyQuantities) {
    if (!applies(body.shape)) continue;
    check_range(where, quantity.key, body.*quantity.member, quantity.range);
  }
  if (body.shape == BodyShape::ellipsoid) {
    for (const double radius : body.radii_mm) check_range(where, "radii_mm", radius, kBodySizeMm);
  }
  if (body.shape == BodyShape::cylinder || body.shape == BodyShape::punch) check_edge(body, where);
  if (body.shape == BodyShape::height_map) check_height_map(body, scene.skin, where);
  check_path(body.path, where);
  for (const BodyKey& key : body.path) {
    check_range(where, "angle_deg", key.angle_deg, kPathAngleDeg);
  }
  check_steps(body, scene, where);
}

void check_bodies(const Scene& scene, const char* where) {
  check_range(where, "modulus_kpa", scene.modulus_kpa, kModulusKpa);
  if (scene.bodies.size() > kMaxBodies) {
    throw Error(where, fmt::format("the scene has {} bodies", scene.bodies.size()),
                fmt::format("it may have {}", kMaxBodies));
  }
  if (!scene.bodies.empty() && std::holds_alternative<DirectionSweep>(scene.load)) {
    throw Error(where, "the scene has bodies and a direction sweep", "leave one of them out");
  }
  int number = 0;
  for (const Body& body : scene.bodies) {
    check_body(body, scene, fmt::format("{}: body {}", where, ++number));
  }
}

void check_direction_sweep(const DirectionSweep& sweep, const Skin& skin,
                           const std::string& where) {
  check_range(where, "directions", sweep.directions, {1, kMaxPillars});
  check_range(where, "inclinations", sweep.inclinations, {1, kMaxPillars});
  check_range(where, "max_theta_deg", sweep.max_theta_deg, kMaxThetaDeg);
  for (const double magnitude : sweep.magnitudes_n) {
    check_range(where, "magnitudes_n", magnitude, kMagnitudeN);
  }
  check_times(sweep.path, where);
  for (const FactorKey& key : sweep.path) check_range(where, "factor", key.factor, kSweepFactor);
  if (skin.pillar_rows() == pillar_rows(sweep) && skin.pillar_cols() == sweep.directions) return;
  throw Error(
      where, fmt::format("the skin has {} x {} pillars", skin.pillar_rows(), skin.pillar_cols()),
      fmt::format("its direction sweep needs {} x {}", pillar_rows(sweep), sweep.directions));
}

}  // namespace

bool is_possible(ContactShape shape, ContactMotion motion) {
  switch (motion) {
    case ContactMotion::press:
    case ContactMotion::slide:
      return true;
    case ContactMotion::partial_slip:
      return shape == ContactShape::sphere;
    case ContactMotion::spin:
      return shape != ContactShape::cylinder;
    case ContactMotion::roll:
      return shape == ContactShape::cylinder;
  }
  return false;
}

std::optional<double> full_scale_of(const SensorModel& sensor) {
  if (!sensor.adc_bits) return std::nullopt;
  return std::ldexp(1.0, *sensor.adc_bits) - 1;
}

void check(const Scene& scene, const char* where) {
  check(scene.skin, where);
  if (scene.skin.sensels() > kMaxSkinSensels) {
    throw Error(where, fmt::format("the skin has {} sensels", scene.skin.sensels()),
                fmt::format("a scene takes {} at most", kMaxSkinSensels));
  }
  check_sensor(scene.sensor, scene.skin, where);
  if (scene.bending) check_bending(*scene.bending, where);
  check_range(where, "rate_hz", scene.rate_hz, kRateHz);
  check_range(where, "frames", scene.frames, {1, kMaxFrames});
  if (scene.parity_tolerance_counts) {
    check_range(where, "parity_tolerance_counts", *scene.parity_tolerance_counts,
                kParityToleranceCounts);
  }
  if (scene.baseline_time_s) {
    check_range(where, "baseline_time_s", *scene.baseline_time_s, kBaselineTimeS);
  }
  check_bodies(scene, where);
  if (const DirectionSweep* sweep = std::get_if<DirectionSweep>(&scene.load)) {
    check_direction_sweep(*sweep, scene.skin, where);
    return;
  }
  int number = 0;
  for (const Contact& contact : std::get<std::vector<Contact>>(scene.load)) {
    check_contact(contact, fmt::format("{}: contact {}", where, ++number));
  }
}

}  // namespace pillarfield
