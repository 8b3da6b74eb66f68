#pragma once

#include <array>
#include <cstddef>

namespace pillarfield {

/// Carlson's symmetric elliptic integrals,
///
///     first  = R_F(x, y, z) = 1/2 ∫ dt / sqrt((t+x)(t+y)(t+z)),           t from 0 to infinity
///     second = R_D(x, y, z) = 3/2 ∫ dt / (sqrt((t+x)(t+y)(t+z)) (t+z))
///
/// by duplication until the arguments nearly agree, and a series about their mean (B. C. Carlson,
/// Numerical Algorithms 10 (1995) 13-26).
struct CarlsonIntegrals {
  double first;
  double second;
};

/// Requires x, y >= 0, at most one of them zero, and z > 0. Relative error: 1e-14.
[[nodiscard]] CarlsonIntegrals carlson_integrals(double x, double y, double z);

/// Arguments and integrals of several points at a time.
inline constexpr std::size_t kCarlsonLanes = 8;
using CarlsonLanes = std::array<double, kCarlsonLanes>;
struct CarlsonArguments {
  CarlsonLanes x;
  CarlsonLanes y;
  CarlsonLanes z;
};

/// The same for each lane. Duplicates until all lanes nearly agree: 6 steps of three square roots
/// for similar arguments, 12 for a range of 24 decades.
void carlson_integrals(CarlsonArguments at, CarlsonLanes& first, CarlsonLanes& second);

}  // namespace pillarfield
