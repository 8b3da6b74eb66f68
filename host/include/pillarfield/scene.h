#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pillarfield/body.h"
#include "pillarfield/contact.h"
#include "pillarfield/skin.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// What makes a sensor differ from the model, each absent (zero or unset) unless the scene lists
/// it. The order is that of the signal: dead zone, the skin's power law, sensitivity, tare, drift,
/// noise, converter, dead.
struct SensorModel {
  double dead_zone_counts = 0;  ///< what a sensel swallows before it answers
  double gain_spread = 0;       ///< relative standard deviation of the sensels' sensitivity, < 0.3
  double tare_counts = 0;       ///< mean reading of an unloaded sensel
  double tare_spread_counts = 0;  ///< its standard deviation over sensels
  double noise_counts = 0;        ///< standard deviation of a reading over frames
  double drift_counts_per_s = 0;  ///< standard deviation over sensels of their constant drift
  std::optional<int> adc_bits;    ///< 1..16; readings are rounded to whole counts; unset: float32
  double dead_share = 0;          ///< share of the sensels that always read zero, 0..1
};

/// A frame in which every pillar has a force of its own: direction phi runs along a row, theta down
/// the columns, and the whole chart repeats for each magnitude.
struct Chart {
  std::uint32_t directions = 72;    ///< columns: phi in equal steps over the circle
  std::uint32_t inclinations = 31;  ///< rows of a block: theta from 0 to max_theta_deg
  double max_theta_deg = 90;
  std::vector<double> magnitudes_n = {0.3};  ///< blocks, top to bottom
};

/// A scene file (docs/scenes.md): the skin, the sensor, the time, and what touches it.
struct Scene {
  std::string title;
  Skin skin;
  SensorModel sensor;
  double rate_hz = 100;
  std::uint32_t frames = 1;
  std::uint64_t seed = 1;
  std::optional<double> parity_tolerance_counts;  ///< see SolverPlan, as the four that follow
  Estimator estimator = Estimator::direct;
  double segment_point = kSegmentPoint;
  FrictionKnowledge friction;
  bool angles = false;
  bool uncertainty = false;
  std::optional<double> baseline_time_s;  ///< time constant with which the tare follows a drift
  std::vector<std::string> remarks;       ///< on what its file says, as of former names
  std::variant<std::vector<Contact>, Chart> load;
  std::vector<Body> bodies;   ///< beside contacts, not beside a chart
  double modulus_kpa = 1000;  ///< Young's modulus of the skin under bodies; incompressible
};

/// Sets what a scene asks of the solver, and the sensor's noise where the scene has any.
void set_solver(SolverPlan& plan, const Scene& scene);

/// Reads a scene from a TOML file. Throws Error with file, line, key and the allowed values. Height
/// maps are not opened; their paths, given relative to the scene's folder, have it before them.
[[nodiscard]] Scene load_scene(const std::filesystem::path& path);

/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::string& name);

}  // namespace pillarfield
