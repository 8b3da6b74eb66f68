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

/// Deviations of a sensor from the model, absent by default. They apply in the order of the signal:
/// dead zone, the skin's power law, sensitivity, tare, drift, noise, converter, dead sensels.
struct SensorModel {
  double dead_zone_counts = 0;    ///< load below which a sensel reads zero
  double gain_spread = 0;         ///< relative standard deviation of sensitivity, < 0.3
  double tare_counts = 0;         ///< mean reading of an unloaded sensel
  double tare_spread_counts = 0;  ///< standard deviation of the tare over sensels
  double noise_counts = 0;        ///< standard deviation of a reading from frame to frame
  double drift_counts_per_s = 0;  ///< standard deviation over sensels of a constant drift
  std::optional<int> adc_bits;    ///< converter, 1 to 16 bits; unset: float32, not rounded
  double dead_share = 0;          ///< fraction of sensels that always read zero, [0, 1]
};

/// A frame that sweeps all directions of force: phi along rows, theta down columns, one block per
/// magnitude.
struct Chart {
  std::uint32_t directions = 72;    ///< columns: phi in equal steps over a circle
  std::uint32_t inclinations = 31;  ///< rows of a block: theta from 0 to max_theta_deg
  double max_theta_deg = 90;
  std::vector<double> magnitudes_n = {0.3};  ///< blocks, top to bottom
};

/// A scene (docs/scenes.md): the skin, its sensor, the frames, and what touches it.
struct Scene {
  std::string title;
  Skin skin;
  SensorModel sensor;
  double rate_hz = 100;
  std::uint32_t frames = 1;
  std::uint64_t seed = 1;
  std::optional<double> parity_tolerance_counts;  ///< as in SolverPlan, like the next five members
  Estimator estimator = Estimator::direct;
  double segment_point = kSegmentPoint;
  FrictionKnowledge friction;
  bool angles = false;
  bool uncertainty = false;
  std::optional<double> baseline_time_s;  ///< time constant with which the tare follows drift
  std::vector<std::string> warnings;      ///< warnings about its file, such as former names
  std::variant<std::vector<Contact>, Chart> load;
  std::vector<Body> bodies;   ///< combined with contacts, not with a Chart
  double modulus_kpa = 1000;  ///< Young's modulus of the skin under bodies
};

/// Sets the solver's options, and the noise of the sensor if any, as the scene says. The skin and
/// the calibration of the plan stay.
void set_solver(SolverPlan& plan, const Scene& scene);

/// Reads a scene from a TOML file. Throws Error with file, line, key and the allowed values. Paths
/// of height maps are resolved relative to the file; the maps are not opened.
[[nodiscard]] Scene load_scene(const std::filesystem::path& path);

/// Reads a scene from text; messages use `name` as the file's name.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::string& name);

}  // namespace pillarfield
