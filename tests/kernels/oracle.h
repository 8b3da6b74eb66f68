#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

/// Arithmetic of 113 bits for the oracles, with trigonometry of its own: series and Newton's
/// method. It uses no library beyond + - * / and a double as first guess.
namespace pillarfield::exact {

#ifdef __SIZEOF_FLOAT128__
using Exact = __float128;
#else
using Exact = long double;
static_assert(std::numeric_limits<long double>::digits >= 113, "the oracles need 113 bits");
#endif

[[nodiscard]] inline Exact abs(Exact x) { return x < 0 ? -x : x; }

/// Pi, from Machin's formula.
[[nodiscard]] Exact pi();

/// For |x| up to a few turns: within 1e-31.
[[nodiscard]] Exact sin(Exact x);
[[nodiscard]] Exact cos(Exact x);

/// Relative error below 1e-32, for x within the range of double.
[[nodiscard]] Exact sqrt(Exact x);

/// The angle of (x, y) in (-pi, pi], relative error below 1e-31; not a number where both are zero.
[[nodiscard]] Exact atan2(Exact y, Exact x);

}  // namespace pillarfield::exact

/// Independent solution of a pillar, without code of kernels/pillar: equation (2) of the paper with
/// its sines and cosines, Gaussian elimination, and bisection, in 113 bits.
namespace pillarfield::oracle {

using exact::Exact;

/// As in kernels/pillar: newtons, shear on the skin, + right and + up, pressing positive.
struct Force {
  Exact shear_x;
  Exact shear_y;
  Exact normal;
};

using Readings = std::array<Exact, 4>;                     ///< of sensels 1 to 4, counts
using SomeReadings = std::array<std::optional<Exact>, 4>;  ///< absent where not usable

[[nodiscard]] Exact magnitude(const Force& force);

/// Direction in which sensel 0..3 lies, radians.
[[nodiscard]] Exact sensel_angle(std::size_t sensel);

/// The force that comes from (theta, phi), radians.
[[nodiscard]] Force force_from(Exact magnitude, Exact theta, Exact phi);

/// Equation (2), negative for inactive sensels. `k` in counts per newton.
[[nodiscard]] Readings readings_from(Exact magnitude, Exact theta, Exact phi, Exact k);

/// The same for a force by its components.
[[nodiscard]] Readings readings_of(const Force& force, Exact k);

/// The force whose readings fit three or four usable ones best: the normal equations, eliminated.
[[nodiscard]] Force least_squares(const SomeReadings& usable, Exact k);

/// The forces with normal >= 0 that give one usable reading, or two adjacent ones, exactly, and
/// none of the inactive sensels more than `hidden` counts: a segment from normal = 0 to the end
/// that bisection finds. Two opposite inactive sensels read equal values.
struct Segment {
  Force low;
  Force high;
};
[[nodiscard]] Segment segment_of(const SomeReadings& usable, Exact k, Exact hidden = 0);

/// The solution of docs/derivations/direct_solve.md for pillars whose other sensels are inactive:
/// least squares if the force is determined; else the segment point (two usable readings) or the
/// segment's midpoint (one); zero without usable readings. Two opposite usable readings are
/// completed by two equal ones.
[[nodiscard]] Force direct_force(const SomeReadings& usable, Exact k, Exact hidden = 0,
                                 Exact segment_point = Exact{7} / 8);

/// By how much the largest component of `estimate(usable)` changes, relative to the force's
/// magnitude, when every reading changes by the same small share of itself at the worst signs:
/// the sum of the one-sided derivatives' magnitudes, by differences
/// (docs/derivations/conditioning.md, C1). Not a number where the estimate is none.
using Estimate = std::function<Force(const SomeReadings&)>;
[[nodiscard]] double condition_number(const SomeReadings& usable, const Estimate& estimate);

// The paper's equations (2), (5), (7) and (8), errata mended, in 113 bits: ratios of readings,
// tangents and angles as they are printed, and none of the code of kernels/pillar.

/// Choices that the equations leave in regions 1 and 2: the sensels i, j of (5), and the one whose
/// reading gives the magnitude by (2).
struct PaperChoice {
  std::size_t i = 0;
  std::size_t j = 2;
  std::size_t magnitude_from = 0;
};

/// The choices of docs/derivations/paper_solve.md for usable readings: P1, P2, and the largest
/// reading. More than one where they are a tie.
[[nodiscard]] std::vector<PaperChoice> paper_choices(const SomeReadings& usable);

/// The paper's force for one to four usable readings: in regions 1 and 2 with a choice, in region 3
/// half way in theta along the contour of (5), in region 4 along the skin. Two opposite readings
/// are no region of the paper; they get direct_force. Not a number where an equation is 0/0.
[[nodiscard]] Force paper_force(const SomeReadings& usable, Exact k, const PaperChoice& choice);

}  // namespace pillarfield::oracle
