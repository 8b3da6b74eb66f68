#pragma once

#include <limits>

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
