#include "bench/variants.h"

#include <fmt/format.h>

#include <array>
#include <random>

#include "pillarfield/error.h"
#include "pillarfield/force_field.h"

namespace pillarfield::bench {
namespace {

constexpr double kNoiseCounts = 0.5;

/// A plane of uniformly distributed values, `low` to `high`.
std::vector<float> uneven_plane(const Skin& skin, float low, float high, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(low, high);
  std::vector<float> plane(skin.sensels());
  for (float& each : plane) each = value(random);
  return plane;
}

void add_tare(SolverPlan& plan) { plan.calibration.tare = uneven_plane(plan.skin, 0, 3, 1); }

void add_gain(SolverPlan& plan) { plan.calibration.gain = uneven_plane(plan.skin, 0.9F, 1.1F, 2); }

void add_dead_zone(SolverPlan& plan) {
  plan.calibration.dead_zone = uneven_plane(plan.skin, 1, 2, 3);
}

/// Masks 0.3 % of the sensels.
void add_mask(SolverPlan& plan) {
  for (const float value : uneven_plane(plan.skin, 0, 1, 4)) {
    plan.calibration.mask.push_back(value < 0.997F ? 1 : 0);
  }
}

/// A few per cent of the frames' readings reach this full scale.
void add_saturation(SolverPlan& plan) {
  plan.skin.full_scale_counts = plan.sensel_type == SenselType::u16 ? 16 * 200 : 200;
}

void add_parity(SolverPlan& plan) { plan.parity_tolerance_counts = 5; }

void add_angles(SolverPlan& plan) { plan.angles = true; }

void add_uncertainty(SolverPlan& plan) {
  plan.noise_counts = kNoiseCounts;
  plan.uncertainty = true;
}

void add_baseline(SolverPlan& plan) { plan.baseline_rate = 0.01; }

void add_power_law(SolverPlan& plan) { plan.skin.power_law = PowerLaw{0.8, 100}; }

SensorEffects& effects(SolverPlan& plan) { return plan.calibration.effects; }

void add_curve(SolverPlan& plan) { effects(plan).curve = {{30, 90, 180, 255}, {25, 80, 170, 250}}; }

void add_shear_coefficient(SolverPlan& plan) { effects(plan).shear_coefficient = {0.9, 0.9}; }

void add_leak(SolverPlan& plan) { effects(plan).sensel_leak = {0.05, 0.02}; }

void add_memory(SolverPlan& plan) {
  effects(plan).memory = {{{0, 0.02}, {30, 0.02}, {90, 0.02}}, {{0.3, 0.02}, {10, 0.02}}};
}

void add_wires(SolverPlan& plan) { effects(plan).wires = {64, 64, 1e-5, 1e-5, 1e-5}; }

void add_pillar_leak(SolverPlan& plan) { effects(plan).pillar_leak = {0.02, 0.005}; }

void add_lean(SolverPlan& plan) { effects(plan).arm_mm = 0.224; }

void add_residual(SolverPlan& plan) {
  add_uncertainty(plan);
  effects(plan).residual = {0.02, 0.5};
}

/// Patterns of the tare of a bent skin. The frames are those of a flat one, whose idle sensels read
/// zero: so do their tares, or the curvature would explain the difference. Below the noise it
/// stays.
void add_bending(SolverPlan& plan) {
  plan.noise_counts = 1;
  plan.calibration.tare.assign(plan.skin.sensels(), 0);
  plan.calibration.bend_x = uneven_plane(plan.skin, -60, 60, 5);
  plan.calibration.bend_y = uneven_plane(plan.skin, -60, 60, 6);
  plan.calibration.bend_xy = uneven_plane(plan.skin, -60, 60, 7);
}

/// The corrections that every calibrated skin has.
void add_calibrated(SolverPlan& plan) {
  add_tare(plan);
  add_gain(plan);
}

/// All corrections of a real sensor.
void add_sensor(SolverPlan& plan) {
  for (const auto add : {add_tare, add_gain, add_dead_zone, add_curve, add_shear_coefficient,
                         add_leak, add_memory, add_wires, add_lean}) {
    add(plan);
  }
}

void add_all(SolverPlan& plan) {
  for (const auto add :
       {add_tare, add_gain, add_mask, add_dead_zone, add_saturation, add_uncertainty, add_angles}) {
    add(plan);
  }
}

struct Stage {
  std::string_view name;
  void (*add)(SolverPlan&);
};

constexpr std::array kStages = {
    Stage{"none", [](SolverPlan&) {}},
    Stage{"tare", add_tare},
    Stage{"gain", add_gain},
    Stage{"dead_zone", add_dead_zone},
    Stage{"mask", add_mask},
    Stage{"saturation", add_saturation},
    Stage{"parity", add_parity},
    Stage{"angles", add_angles},
    Stage{"uncertainty", add_uncertainty},
    Stage{"baseline", add_baseline},
    Stage{"power_law", add_power_law},
    Stage{"all", add_all},
    Stage{"curve", add_curve},
    Stage{"shear_coefficient", add_shear_coefficient},
    Stage{"leak", add_leak},
    Stage{"memory", add_memory},
    Stage{"wires", add_wires},
    Stage{"pillar_leak", add_pillar_leak},
    Stage{"lean", add_lean},
    Stage{"residual", add_residual},
    Stage{"bending", add_bending},
    Stage{"calibrated", add_calibrated},
    Stage{"sensor", add_sensor},
    Stage{"sensels", [](SolverPlan& plan) { plan.skin.layout = SkinLayout::sensels; }},
};

}  // namespace

SolverPlan bare_plan(std::uint32_t pillars_a_side, SenselType type) {
  SolverPlan plan;
  plan.skin.rows = 2 * pillars_a_side;
  plan.skin.cols = 2 * pillars_a_side;
  plan.sensel_type = type;
  plan.estimator = Estimator::direct;
  return plan;
}

std::vector<std::string_view> stage_names() {
  std::vector<std::string_view> names;
  names.reserve(kStages.size());
  for (const Stage& stage : kStages) names.push_back(stage.name);
  return names;
}

void add_stage(SolverPlan& plan, std::string_view name) {
  for (const Stage& stage : kStages) {
    if (stage.name == name) return stage.add(plan);
  }
  throw Error("bench", fmt::format("unknown stage '{}'", name),
              fmt::format("choose from: {}", fmt::join(stage_names(), ", ")));
}

std::size_t Streams::bytes_per_pillar() const {
  const std::size_t frame = 4 * size_of(sensel_type);
  const std::size_t calibration =
      16 * static_cast<std::size_t>(calibration_planes) + (mask ? 4 : 0) + (tare_follows ? 16 : 0);
  return frame + calibration + sizeof(float) * static_cast<std::size_t>(result_planes) + 1;
}

Streams streams_of(const SolverPlan& plan) {
  const Calibration& calibration = plan.calibration;
  Streams streams;
  streams.sensel_type = plan.sensel_type;
  const bool tare = !calibration.tare.empty() || plan.baseline_rate;
  const bool noise = !calibration.noise.empty() && plan.uncertainty;
  for (const bool read : {tare, !calibration.gain.empty(), !calibration.dead_zone.empty(), noise}) {
    streams.calibration_planes += read ? 1 : 0;
  }
  streams.mask = !calibration.mask.empty();
  streams.tare_follows = plan.baseline_rate.has_value();
  // A float and a byte for each of 2 x 2 sensels: 20 bytes, but the copy writes 21.
  if (!plan.skin.has_pillars()) streams.result_planes = 5;
  if (plan.angles) streams.result_planes += 3;
  if (plan.uncertainty) streams.result_planes += static_cast<int>(kUncertaintyPlanes);
  return streams;
}

}  // namespace pillarfield::bench
