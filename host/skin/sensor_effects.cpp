#include "pillarfield/sensor_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pillarfield/error.h"
#include "skin/effect_parameters.h"
#include "skin/limits.h"

namespace pillarfield {
namespace {

constexpr std::size_t kLeastKnots = 2;
constexpr std::size_t kMostKnots = 64;

void require(std::string_view where, std::string_view name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw Error(where, fmt::format("{} is {:.6g}", name, value),
              fmt::format("it must lie in [{}, {}]", low, high));
}

void check_knots(const std::vector<double>& knots, const char* name, std::string_view where) {
  double before = 0;
  for (const double knot : knots) {
    if (!(knot > before && knot <= kCurveCounts.high)) {
      throw Error(where, fmt::format("the response curve has {} {} after {}", name, knot, before),
                  "its knots must increase from above zero to at most 1e9 counts");
    }
    before = knot;
  }
}

void check(const ResponseCurve& curve, std::string_view where) {
  if (curve.readings.empty() && curve.loads.empty()) return;
  const std::size_t knots = curve.readings.size();
  if (knots != curve.loads.size() || knots < kLeastKnots || knots > kMostKnots) {
    throw Error(
        where,
        fmt::format("the response curve has {} readings and {} loads", knots, curve.loads.size()),
        fmt::format("it needs {} to {} of each", kLeastKnots, kMostKnots));
  }
  check_knots(curve.readings, "reading", where);
  check_knots(curve.loads, "load", where);
}

void check(const SenselMemory& memory, std::string_view where) {
  if (memory.plays.size() > kMaxPlays || memory.creep.size() > kMaxCreeps) {
    throw Error(where,
                fmt::format("the memory has {} plays and {} creep states", memory.plays.size(),
                            memory.creep.size()),
                fmt::format("it may have {} and {}", kMaxPlays, kMaxCreeps));
  }
  double width = 0;
  double slope = 1;
  for (const Play& play : memory.plays) {
    require(where, "a play's width", play.width_counts, width, kCurveCounts.high);
    slope += play.weight;
    require(where, "the slope of the loading curve beyond a play", slope, 1e-3, 1e3);
    width = play.width_counts;
  }
}

/// One cubic of a curve; the knot before the first one is (0, 0).
struct CurvePiece {
  double r0, r1, v0, v1;  ///< its ends
  double slope0, slope1;  ///< dV/dr at its ends
};

double reading_of(const ResponseCurve& curve, std::size_t knot) {
  return knot == 0 ? 0 : curve.readings[knot - 1];
}
double load_of(const ResponseCurve& curve, std::size_t knot) {
  return knot == 0 ? 0 : curve.loads[knot - 1];
}

/// Slope of the chord from `knot` to the next one.
double chord(const ResponseCurve& curve, std::size_t knot) {
  return (load_of(curve, knot + 1) - load_of(curve, knot)) /
         (reading_of(curve, knot + 1) - reading_of(curve, knot));
}

/// dV/dr at a knot: inside the weighted harmonic mean of both chords (Fritsch and Butland 1984),
/// which keeps the cubic monotone; at the ends that of the nearest chord.
double slope_at(const ResponseCurve& curve, std::size_t knot) {
  const std::size_t last = curve.readings.size();
  if (knot == 0) return chord(curve, 0);
  if (knot == last) return chord(curve, last - 1);
  const double before = reading_of(curve, knot) - reading_of(curve, knot - 1);
  const double after = reading_of(curve, knot + 1) - reading_of(curve, knot);
  const double weight_before = 2 * after + before;
  const double weight_after = after + 2 * before;
  return (weight_before + weight_after) /
         (weight_before / chord(curve, knot - 1) + weight_after / chord(curve, knot));
}

CurvePiece piece_from(const ResponseCurve& curve, std::size_t knot) {
  return {reading_of(curve, knot),  reading_of(curve, knot + 1), load_of(curve, knot),
          load_of(curve, knot + 1), slope_at(curve, knot),       slope_at(curve, knot + 1)};
}

/// The cubic of Hermite.
double value_in(const CurvePiece& at, double reading) {
  const double width = at.r1 - at.r0;
  const double t = (reading - at.r0) / width;
  const double u = 1 - t;
  return at.v0 * u * u * (1 + 2 * t) + at.v1 * t * t * (1 + 2 * u) +
         width * t * u * (at.slope0 * u - at.slope1 * t);
}

/// The part of a piece's width at which it has the value `load`: false position with the Illinois
/// rule, which needs about 8 steps.
double part_at(const CurvePiece& at, double load) {
  double low = 0;
  double high = 1;
  double below = at.v0 - load;
  double above = at.v1 - load;
  double part = 1;
  double before = 0;
  for (int step = 0; step < 60 && above > 0; ++step) {
    part = low + (high - low) * below / (below - above);
    const double excess = value_in(at, std::lerp(at.r0, at.r1, part)) - load;
    if (std::abs(excess) <= 1e-15 * load) break;
    if (excess < 0) {
      low = part;
      below = excess;
      if (before < 0) above /= 2;
    } else {
      high = part;
      above = excess;
      if (before > 0) below /= 2;
    }
    before = excess;
  }
  return part;
}

/// Index of the piece that holds `value` of increasing `knots`; the number of knots beyond.
std::size_t piece_of(const std::vector<double>& knots, double value) {
  return static_cast<std::size_t>(std::ranges::lower_bound(knots, value) - knots.begin());
}

}  // namespace

void check(const SensorEffects& effects, std::string_view where) {
  check(effects.curve, where);
  if (effects.pillar_leak) {
    const auto& [edge, corner] = *effects.pillar_leak;
    require(where,
            fmt::format("the leak between pillars, 4 (|edge {}| + |corner {}|),", edge, corner),
            4 * (std::abs(edge) + std::abs(corner)), 0, kMostPillarLeak);
  }
  for (const EffectParameter& parameter : parameters_of(effects)) {
    for (const double value : parameter.values) {
      if (parameter.range.contains(value)) continue;
      throw Error(where, fmt::format("{} is {:.6g}", parameter.name, value),
                  fmt::format("it must be {}", parameter.range.text()));
    }
  }
  if (effects.memory) check(*effects.memory, where);
}

SensorEffects without_pillars(SensorEffects effects) {
  effects.shear_coefficient.reset();
  effects.pillar_leak.reset();
  effects.arm_mm.reset();
  return effects;
}

bool have_neighbours(const SensorEffects& effects) {
  return effects.sensel_leak || effects.pillar_leak;
}

double sensel_sum(const SensorEffects& effects, int missing) {
  const SenselLeak leak = effects.sensel_leak.value_or(SenselLeak{});
  return 1 + 2 * leak.inside + (2 - missing) * leak.across;
}

double sensel_sum(const SensorEffects& effects, const Skin& skin, std::size_t sensel) {
  const std::size_t row = sensel / skin.cols;
  const std::size_t col = sensel % skin.cols;
  const std::size_t solved_rows = skin.has_pillars() ? 2 * skin.pillar_rows() : skin.rows;
  const std::size_t solved_cols = skin.has_pillars() ? 2 * skin.pillar_cols() : skin.cols;
  const int at_row_edge = row == 0 || row + 1 == solved_rows ? 1 : 0;
  const int at_col_edge = col == 0 || col + 1 == solved_cols ? 1 : 0;
  return sensel_sum(effects, at_row_edge + at_col_edge);
}

double pillar_sum(const SensorEffects& effects) {
  const PillarLeak leak = effects.pillar_leak.value_or(PillarLeak{});
  return 1 + 4 * leak.edge + 4 * leak.corner;
}

double linear_sum(const SensorEffects& effects) {
  return sensel_sum(effects) * pillar_sum(effects);
}

double linear_sum(const SensorEffects& effects, const Skin& skin, std::size_t sensel) {
  return sensel_sum(effects, skin, sensel) * pillar_sum(effects);
}

double load_at(const ResponseCurve& curve, double reading) {
  if (!(reading > 0) || curve.empty()) return reading;
  const std::size_t last = curve.readings.size();
  const std::size_t knot = piece_of(curve.readings, reading);
  if (knot < last) return value_in(piece_from(curve, knot), reading);
  return curve.loads.back() + slope_at(curve, last) * (reading - curve.readings.back());
}

double reading_at(const ResponseCurve& curve, double load) {
  if (!(load > 0) || curve.empty()) return load;
  const std::size_t last = curve.readings.size();
  const std::size_t knot = piece_of(curve.loads, load);
  if (knot == last) {
    return curve.readings.back() + (load - curve.loads.back()) / slope_at(curve, last);
  }
  const CurvePiece at = piece_from(curve, knot);
  return at.r0 + (at.r1 - at.r0) * part_at(at, load);
}

}  // namespace pillarfield
