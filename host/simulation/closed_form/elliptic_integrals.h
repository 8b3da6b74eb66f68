#pragma once

namespace pillarfield {

/// Carlson's symmetric elliptic integrals,
///
///     first  = R_F(x, y, z) = 1/2 ∫ dt / sqrt((t+x)(t+y)(t+z)),           t from 0 to infinity
///     second = R_D(x, y, z) = 3/2 ∫ dt / (sqrt((t+x)(t+y)(t+z)) (t+z))
///
/// by duplication (B. C. Carlson, Numerical Algorithms 10 (1995) 13-26).
struct CarlsonIntegrals {
  double first;
  double second;
};

/// Requires x, y >= 0, at most one of them zero, and z > 0. Relative error: 1e-14. Cost: 15 steps
/// of three square roots for similar arguments, 20 for a range of 24 decades.
[[nodiscard]] CarlsonIntegrals carlson_integrals(double x, double y, double z);

}  // namespace pillarfield
