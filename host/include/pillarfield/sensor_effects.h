#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/skin.h"

namespace pillarfield {

/// Response of all sensels: the load V, counts, at a corrected reading r = (raw − tare)·gain.
/// Between the knots V is a monotone cubic (Fritsch and Carlson 1980), beyond the last one a
/// straight line; V(0) = 0. Excludes Skin::power_law (docs/derivations/sensor_effects.md, E1).
struct ResponseCurve {
  std::vector<double> readings;  ///< r of the knots, counts, above zero, increasing; 2 to 64
  std::vector<double> loads;     ///< V of the knots, counts, above zero, increasing

  [[nodiscard]] bool empty() const { return readings.empty(); }
};

/// Sensitivity to shear: V = k (normal ± c_x shear_x/√2 ± c_y shear_y/√2). The paper's pillar has
/// c = 1 (E2).
struct ShearCoefficient {
  double x = 1;  ///< 0.1..10
  double y = 1;
};

/// Fraction of its neighbours' V that a sensel reads too, through the silicone or the wiring (E3):
/// reading = V + inside · (both edge neighbours under its pillar) + across · (both beyond it).
struct SenselLeak {
  double inside = 0;  ///< ±kMostSenselLeak
  double across = 0;
};
inline constexpr double kMostSenselLeak = 0.2;

/// Fraction of its neighbours' force that a pillar carries too, through the silicone (E4). Of all
/// eight, 4 (|edge| + |corner|), at most kMostPillarLeak: larger leaks are not corrected well.
struct PillarLeak {
  double edge = 0;    ///< of each of the four nearest pillars
  double corner = 0;  ///< of each of the four diagonal pillars
};
inline constexpr double kMostPillarLeak = 0.5;

/// The cause of the readings of unloaded sensels behind wires.
enum class TareOrigin : std::uint8_t {
  conductance,  ///< unloaded sensels conduct: the wires act on tare and load
  offset,       ///< the converter adds the tare: the wires act on the load alone
};

/// Crosstalk of a scanned array whose rows and columns have series resistance (E5). The array is
/// wired in tiles, from the upper left sensel on, each with rows and columns of its own.
struct WireCrosstalk {
  std::uint32_t tile_rows = 64;  ///< sensels, 2..1024
  std::uint32_t tile_cols = 64;
  double row_per_count = 0;     ///< resistance of a driven row times the conductance of one count
  double column_per_count = 0;  ///< of a column
  double idle_per_count = 0;    ///< of a row that is not driven
  TareOrigin tares = TareOrigin::conductance;
};

/// One-sided play operator: p follows V between V − width and V and stays in between (E6).
struct Play {
  double width_counts = 0;
  double weight = 0;  ///< the reading gains weight · p
};

/// A state that follows V exponentially (E6).
struct Creep {
  double time_s = 0;
  double weight = 0;  ///< the reading gains weight · state
};

/// Hysteresis and creep of all sensels: reading = V + Σ plays + Σ creep. Frames must come in their
/// order, SolverPlan::frame_interval_s apart.
struct SenselMemory {
  std::vector<Play> plays;   ///< at most kMaxPlays, widths increasing
  std::vector<Creep> creep;  ///< at most kMaxCreeps
};
inline constexpr std::size_t kMaxPlays = 4;
inline constexpr std::size_t kMaxCreeps = 2;

/// Error, beside noise, that calibration leaves in a corrected reading V: standard deviations of
/// relative·V and of offset_counts. Curves, hysteresis and creep are common to the sensels of a
/// pillar, gains are not; stated deviations allow for both: `relative` is counted once as
/// independent from sensel to sensel, and once as common to all components of the force;
/// `offset_counts` as common to the sensels, and so in the normal force (E9).
struct ResidualError {
  double relative = 0;       ///< 0..1
  double offset_counts = 0;  ///< >= 0
};

/// Effects of a real sensor that all its sensels share (docs/sensors.md). Each one that is set adds
/// its stage; an absent one costs nothing.
struct SensorEffects {
  ResponseCurve curve;
  std::optional<ShearCoefficient> shear_coefficient;
  std::optional<SenselLeak> sensel_leak;
  std::optional<PillarLeak> pillar_leak;
  std::optional<WireCrosstalk> wires;
  std::optional<SenselMemory> memory;
  /// Arm of a pillar, mm: pressure p at (x, y) from its axis reads as a shear of p·(x, y)/arm (E7).
  std::optional<double> arm_mm;
  std::optional<ResidualError> residual;

  [[nodiscard]] bool empty() const;
};

/// The names of the effects that are set: "curve", "sensel_leak".
[[nodiscard]] std::vector<std::string> names_of(const SensorEffects& effects);

/// The effects of a skin without pillars: those of pillars are left out.
[[nodiscard]] SensorEffects without_pillars(SensorEffects effects);

/// True if a reading depends on the load of neighbours.
[[nodiscard]] bool have_neighbours(const SensorEffects& effects);

// The effects between neighbours are linear. Under a uniform load each is a factor:

/// Factor of V of a sensel, if `missing` of its two neighbours under other pillars
/// lie beyond the edge. Dead zones lie before the effects between sensels.
[[nodiscard]] double sensel_sum(const SensorEffects& effects, int missing = 0);
/// That of the sensel with this index.
[[nodiscard]] double sensel_sum(const SensorEffects& effects, const Skin& skin, std::size_t sensel);

/// Factor of the force on a pillar with eight neighbours; before dead zones.
[[nodiscard]] double pillar_sum(const SensorEffects& effects);

/// Both, of a sensel in the middle of the skin.
[[nodiscard]] double linear_sum(const SensorEffects& effects);
/// Both, of the sensel with this index. All pillars count as having eight neighbours.
[[nodiscard]] double linear_sum(const SensorEffects& effects, const Skin& skin, std::size_t sensel);

/// True if tares are an offset behind the wires, and so do not load them.
[[nodiscard]] constexpr bool has_offset_tares(const SensorEffects& effects) {
  return effects.wires && effects.wires->tares == TareOrigin::offset;
}

/// Throws Error, naming `where`, if a member is out of range.
void check(const SensorEffects& effects, std::string_view where);

/// V of the curve at reading r; r <= 0 is returned unchanged.
[[nodiscard]] double load_at(const ResponseCurve& curve, double reading);

/// The reading at which the curve gives V; the inverse of load_at().
[[nodiscard]] double reading_at(const ResponseCurve& curve, double load);

}  // namespace pillarfield
