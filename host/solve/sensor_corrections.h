#pragma once

#include "pillarfield/sensor_effects.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// The polynomial that stands in for a response curve up to kCurveReach times its last knot: the
/// better one of two least squares, in powers of the reading or of its root, each with the most
/// terms that increases everywhere (E1). Zero for an empty curve.
struct CurveFit {
  single_precision::CurvePolynomial polynomial{};
  double rms_counts = 0;  ///< of its differences from the curve
};
[[nodiscard]] CurveFit curve_polynomial(const ResponseCurve& curve);
inline constexpr double kCurveReach = 1.25;

/// The reading at which the polynomial gives `load`, >= 0 counts.
[[nodiscard]] double reading_at(const single_precision::CurvePolynomial& curve, double load);

/// The leak to the sensel in row or column `at` from its neighbour `step` (-1 or 1) beside it.
[[nodiscard]] inline double leak_from(const SenselLeak& leak, int at, int step) {
  return step == double_precision::inward(at) ? leak.inside : leak.across;
}

/// The inverse of a leak, cut to 3 x 3 sensels; a uniform field keeps its exact inverse
/// (docs/derivations/sensor_effects.md, E3).
[[nodiscard]] double_precision::LeakTaps leak_taps(const SenselLeak& leak);

/// The 3 x 3 weights nearest to the inverse of a leak between pillars; a uniform field keeps its
/// exact inverse (E4).
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
