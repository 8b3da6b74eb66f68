#pragma once

namespace pillarfield {

/// Carlson's symmetric elliptic integrals of the same three arguments,
///
///     first  = R_F(x, y, z) = 1/2 ∫ dt / sqrt((t+x)(t+y)(t+z)),           t from 0 to infinity
///     second = R_D(x, y, z) = 3/2 ∫ dt / (sqrt((t+x)(t+y)(t+z)) (t+z))
///
/// by duplication (B. C. Carlson, Numerical Algorithms 10 (1995) 13-26).
struct CarlsonIntegrals {
  double first;
  double second;
};

/// Needs x, y >= 0, of which one at most is zero, and z > 0. Within 1e-14 relative; 15 steps where
/// the arguments are alike, 20 where they differ by 24 decades, of three square roots each.
[[nodiscard]] CarlsonIntegrals carlson_integrals(double x, double y, double z);

}  // namespace pillarfield
