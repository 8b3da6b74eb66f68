#pragma once

#include <vector>

#include "pillarfield/sensor_effects.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// The table of a response curve: V at PF_CURVE_PIECES + 1 equidistant readings.
struct CurveTable {
  std::vector<float> loads;  ///< counts
  double per_count = 0;      ///< pieces of one count
};
[[nodiscard]] CurveTable curve_table(const ResponseCurve& curve);

/// The reading at which a table gives `load`, >= 0 counts.
[[nodiscard]] double reading_in(const CurveTable& table, double load);

/// The inverse of a leak, cut to 3 x 3 sensels; a uniform field keeps its exact inverse
/// (docs/derivations/sensor_effects.md, E3).
[[nodiscard]] double_precision::LeakTaps leak_taps(const SenselLeak& leak);

/// Weights of the inverse of a leak between pillars, cut to 3 x 3 pillars likewise (E4).
struct PillarTaps {
  double self = 1;
  double edge = 0;
  double corner = 0;
};
[[nodiscard]] PillarTaps pillar_leak_taps(const PillarLeak& leak);

/// The inverse of a sensel's memory at this interval of frames, s (E6).
[[nodiscard]] single_precision::MemoryModel memory_model(const SenselMemory& memory,
                                                         double frame_interval_s);

}  // namespace pillarfield
