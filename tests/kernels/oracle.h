#pragma once

#include <array>
#include <optional>

#include "exact.h"

/// A pillar by another way than kernels/maths, and with none of its code: equation (2) of the paper
/// with its sines and cosines, Gaussian elimination, and bisection, in 113 bits.
namespace pillarfield::oracle {

using exact::Exact;

/// As in kernels/maths: newtons, shear on the skin, + right and + up, pressing positive.
struct Force {
  Exact shear_x;
  Exact shear_y;
  Exact normal;
};

using Readings = std::array<Exact, 4>;                     ///< of sensels 1 to 4, counts
using SomeReadings = std::array<std::optional<Exact>, 4>;  ///< absent where not usable

[[nodiscard]] Exact magnitude(const Force& force);

/// The force that comes from (theta, phi), radians.
[[nodiscard]] Force force_from(Exact magnitude, Exact theta, Exact phi);

/// Equation (2), negative where the pillar lifts off. `k` in counts per newton.
[[nodiscard]] Readings readings_from(Exact magnitude, Exact theta, Exact phi, Exact k);

/// The same for a force by its components.
[[nodiscard]] Readings readings_of(const Force& force, Exact k);

/// The force whose readings fit three or four usable ones best: the normal equations, eliminated.
[[nodiscard]] Force least_squares(const SomeReadings& usable, Exact k);

/// The forces with normal >= 0 that give two adjacent usable readings exactly and none of the other
/// two a positive one: a segment from normal = 0 to the end that bisection finds.
struct Segment {
  Force low;
  Force high;
};
[[nodiscard]] Segment segment_of(const SomeReadings& usable, Exact k);

}  // namespace pillarfield::oracle
