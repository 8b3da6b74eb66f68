#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pillarfield/closed_form_contact.h"
#include "pillarfield/indenter.h"
#include "pillarfield/sensor_effects.h"
#include "pillarfield/skin.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Deviations of a sensor from the model, absent by default, in the order of the signal: effects of
/// pillars, dead zone, neighbours, hysteresis and creep, response curve or the skin's power
/// law, sensitivity, tare, wires, drift, noise, converter, dead sensels.
struct SensorModel {
  SensorEffects effects;  ///< without memory and residual
  /// Largest width of the loop of a cycle from zero to hysteresis_range_counts and back, as a
  /// fraction of that range
  double hysteresis = 0;
  std::optional<double> hysteresis_range_counts;  ///< unset: full scale, or 255
  double creep_per_decade = 0;    ///< rise of a reading in ten times the time, as a fraction
  double dead_zone_counts = 0;    ///< load below which a sensel reads zero
  double gain_spread = 0;         ///< relative standard deviation of sensitivity, < 0.3
  double tare_counts = 0;         ///< mean reading of an unloaded sensel
  double tare_spread_counts = 0;  ///< standard deviation of the tare over sensels
  double noise_counts = 0;        ///< standard deviation of a reading from frame to frame
  double drift_counts_per_s = 0;  ///< standard deviation over sensels of a constant drift
  std::optional<int> adc_bits;    ///< converter, 1 to 16 bits; unset: float32, not rounded
  double dead_share = 0;          ///< fraction of sensels that always read zero, [0, 1]
};

/// Curvature of the skin at a time, 1/mm; linear in time between the keys of a path.
struct CurvatureKey {
  double time_s = 0;
  double x = 0;
  double y = 0;
  double xy = 0;
};

/// Change of the tare with bending (Calibration::bend_x): normal random patterns.
struct Bending {
  double spread_counts_mm = 0;  ///< standard deviation of the patterns
  std::vector<CurvatureKey> path;
};

/// Height map of the surface under the skin.
struct SurfaceMap {
  std::filesystem::path path;              ///< .npy, as Indenter::height_map
  std::array<double, 2> size_mm = {0, 0};  ///< along x and y; it must cover the skin
  double depth_mm = 0;                     ///< height of its highest point above its lowest
};

/// Factor of all forces of a DirectionSweep at a time; linear in time between the keys of a path.
struct FactorKey {
  double time_s = 0;
  double factor = 1;
};

/// A frame that sweeps all directions of force: phi along rows, theta down columns, one block per
/// magnitude.
struct DirectionSweep {
  std::uint32_t directions = 72;    ///< columns: phi in equal steps over a circle
  std::uint32_t inclinations = 31;  ///< rows of a block: theta from 0 to max_theta_deg
  double max_theta_deg = 90;
  std::vector<double> magnitudes_n = {0.3};  ///< blocks, top to bottom
  std::vector<FactorKey> path = {{}};        ///< of magnitudes_n
};

/// A scene (docs/scenes.md): the skin, its sensor, the frames, and what touches it.
struct Scene {
  std::string title;
  std::string text;            ///< TOML that it was parsed from
  std::filesystem::path file;  ///< its file; the name given to parse_scene()
  Skin skin;
  SensorModel sensor;
  std::optional<Bending> bending;
  std::optional<SurfaceMap> surface_map;  ///< in place of skin.surface: surface_of()
  double rate_hz = 100;
  std::uint32_t frames = 1;
  std::uint64_t seed = 1;
  std::uint32_t recording = 0;  ///< number of this recording of the seed's sensor; sets its noise
  std::optional<double> parity_tolerance_counts;  ///< as in SolverPlan, like the next four members
  std::optional<Estimator> estimator;
  FrictionKnowledge friction;
  bool angles = false;
  bool uncertainty = false;
  std::optional<double> baseline_time_s;  ///< time constant with which the tare follows drift
  std::vector<std::string> warnings;      ///< warnings about its file, such as former names
  std::variant<std::vector<ClosedFormContact>, DirectionSweep> load;
  std::vector<Indenter> indenters;  ///< combined with contacts, not with a DirectionSweep
  double modulus_kpa = 1000;        ///< Young's modulus of the skin under indenters
};

/// Sets the solver's options, and the noise of the sensor if any, as the scene says. The skin and
/// the calibration of the plan stay.
void set_solver(SolverPlan& plan, const Scene& scene);

/// Gives `skin` the constants of the scene's skin, and its surface if it has one; the size stays.
void set_skin(Skin& skin, const Scene& scene);

/// The surface under the skin; reads its height map and samples it at the pillars. Throws Error if
/// the map is unreadable or does not cover the skin.
[[nodiscard]] std::optional<Surface> surface_of(const Scene& scene);

/// Reads a scene from a TOML file. Throws Error with file, line, key and the allowed values. Paths
/// of height maps are resolved relative to the file; the maps are not opened.
[[nodiscard]] Scene load_scene(const std::filesystem::path& path);

/// Reads a scene from text; messages use `name` as the file's name.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::string& name);

}  // namespace pillarfield
