#include "simulation/scene/scene_limits.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

#include "pillarfield/error.h"
#include "simulation/closed_form/direction_sweep.h"
#include "simulation/effects/memory_history.h"
#include "simulation/effects/pillar_model.h"
#include "simulation/indenter/indenter_path.h"

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
  if (MemoryHistory::is_needed(sensor) && skin.sensels() > kMaxMemorySensels) {
    throw Error(where, fmt::format("the skin has {} sensels", skin.sensels()),
                fmt::format("with hysteresis or creep it may have {}", kMaxMemorySensels));
  }
  if (!sensor.effects.curve.empty() && skin.power_law) {
    throw Error(where, "the sensor has a response curve and a power law", "leave one of them out");
  }
  if (sensor.effects.memory || sensor.effects.residual) {
    throw Error(where, "the sensor has a memory or a residual",
                "give hysteresis and creep_per_decade");
  }
  check(sensor.effects, where);
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

/// Throws Error if a scene without pillars has an effect of pillars, or a sweep of their forces.
void check_layout(const Scene& scene, const std::string& where) {
  if (scene.skin.has_pillars()) return;
  if (!PillarModel(scene.sensor.effects).is_ideal()) {
    throw Error(where, "the skin has no pillars, but its sensor an effect of pillars",
                "leave it out");
  }
  if (std::holds_alternative<DirectionSweep>(scene.load)) {
    throw Error(where, "a direction sweep needs pillars", "give contacts or indenters");
  }
  if (scene.parity_tolerance_counts) {
    throw Error(where, "the parity test needs pillars", "leave parity_tolerance_counts out");
  }
}

void check_contact(const ClosedFormContact& contact, const std::string& where) {
  if (!is_possible(contact.shape, contact.motion)) {
    throw Error(where, "this shape cannot have this motion",
                "see docs/scenes.md for what goes together");
  }
  for (const auto& [quantity, required, applies] : kContactQuantities) {
    if (!applies(contact.shape, contact.motion)) continue;
    check_range(where, quantity.key, contact.*quantity.member, quantity.range);
  }
  check_path(contact.path, where);
}

void check_edge(const Indenter& indenter, const std::string& where) {
  const double most =
      indenter.shape == IndenterShape::cylinder ? indenter.length_mm / 2 : indenter.radius_mm;
  if (indenter.edge_radius_mm <= most) return;
  throw Error(where, fmt::format("edge_radius_mm is {}", indenter.edge_radius_mm),
              indenter.shape == IndenterShape::cylinder ? "it may be half of length_mm"
                                                        : "it may be radius_mm");
}

void check_height_map(const Indenter& indenter, const Skin& skin, const std::string& where) {
  if (indenter.height_map.empty()) throw Error(where, "height_map is missing", "name a file");
  const double most_mm = (kMaxContactPillars - 1) * skin.element_pitch_mm().col_mm;
  for (const double size : indenter.height_map_size_mm) {
    check_range(where, "height_map_size_mm", size, kIndenterSizeMm);
    if (size <= most_mm) continue;
    throw Error(where, fmt::format("height_map_size_mm is {}", size),
                fmt::format("on this skin it may be {:.6g}", most_mm));
  }
}

void check_steps(const Indenter& indenter, const Scene& scene, const std::string& where) {
  check_range(where, "substeps", indenter.substeps, {1, kMaxSubsteps});
  const double steps = steps_of(indenter, scene.rate_hz, scene.frames);
  if (steps <= static_cast<double>(kMaxIndenterSteps)) return;
  throw Error(
      where, fmt::format("it takes {:.0f} steps", steps),
      fmt::format("its path may have {}: fewer frames, substeps or seconds", kMaxIndenterSteps));
}

void check_indenter(const Indenter& indenter, const Scene& scene, const std::string& where) {
  for (const auto& [quantity, required, applies] : kIndenterQuantities) {
    if (!applies(indenter.shape)) continue;
    check_range(where, quantity.key, indenter.*quantity.member, quantity.range);
  }
  if (indenter.shape == IndenterShape::ellipsoid) {
    for (const double radius : indenter.radii_mm)
      check_range(where, "radii_mm", radius, kIndenterSizeMm);
  }
  if (indenter.shape == IndenterShape::cylinder || indenter.shape == IndenterShape::punch)
    check_edge(indenter, where);
  if (indenter.shape == IndenterShape::height_map) check_height_map(indenter, scene.skin, where);
  check_path(indenter.path, where);
  for (const IndenterKey& key : indenter.path) {
    check_range(where, "angle_deg", key.angle_deg, kPathAngleDeg);
  }
  check_steps(indenter, scene, where);
}

void check_indenters(const Scene& scene, const char* where) {
  check_range(where, "modulus_kpa", scene.modulus_kpa, kModulusKpa);
  if (scene.indenters.size() > kMaxIndenters) {
    throw Error(where, fmt::format("the scene has {} indenters", scene.indenters.size()),
                fmt::format("it may have {}", kMaxIndenters));
  }
  if (!scene.indenters.empty() && std::holds_alternative<DirectionSweep>(scene.load)) {
    throw Error(where, "the scene has indenters and a direction sweep", "leave one of them out");
  }
  int number = 0;
  for (const Indenter& indenter : scene.indenters) {
    check_indenter(indenter, scene, fmt::format("{}: indenter {}", where, ++number));
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
  if (skin.element_rows() == pillar_rows(sweep) && skin.element_cols() == sweep.directions) return;
  throw Error(
      where, fmt::format("the skin has {} x {} pillars", skin.element_rows(), skin.element_cols()),
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
  check_layout(scene, where);
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
  check_indenters(scene, where);
  if (const DirectionSweep* sweep = std::get_if<DirectionSweep>(&scene.load)) {
    check_direction_sweep(*sweep, scene.skin, where);
    return;
  }
  int number = 0;
  for (const ClosedFormContact& contact : std::get<std::vector<ClosedFormContact>>(scene.load)) {
    check_contact(contact, fmt::format("{}: contact {}", where, ++number));
  }
}

}  // namespace pillarfield
