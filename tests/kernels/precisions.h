#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>

#include "lab/studies/oracle.h"
#include "solve/pillar_maths.h"

/// One test body for the C++ forms of kernels/pillar: its types by precision. The functions that
/// take one of these types are found by argument-dependent lookup.
namespace pillarfield {

struct Single {
  using Real = float;
  using Force = single_precision::Force;
  using Readings = single_precision::Readings;
  using Sensel = single_precision::Sensel;
  using Pillar = single_precision::Pillar;
  using Diagonals = single_precision::Diagonals;
  using ParitySum = single_precision::ParitySum;
  using ForceScale = single_precision::ForceScale;
  static Sensel raw_sensel(Real raw) { return single_precision::raw_sensel(raw); }
};

struct Double {
  using Real = double;
  using Force = double_precision::Force;
  using Readings = double_precision::Readings;
  using Sensel = double_precision::Sensel;
  using Pillar = double_precision::Pillar;
  using Diagonals = double_precision::Diagonals;
  using ParitySum = double_precision::ParitySum;
  using ForceScale = double_precision::ForceScale;
  static Sensel raw_sensel(Real raw) { return double_precision::raw_sensel(raw); }
};

template <class Precision>
using RealOf = typename Precision::Real;
template <class Precision>
using ForceOf = typename Precision::Force;
template <class Precision>
using SenselOf = typename Precision::Sensel;
template <class Precision>
using PillarOf = typename Precision::Pillar;

using Precisions = testing::Types<Single, Double>;

struct PrecisionNames {
  template <class Precision>
  // GoogleTest's name for it. NOLINTNEXTLINE(readability-identifier-naming)
  static std::string GetName(int /*index*/) {
    return std::is_same_v<Precision, Single> ? "float" : "double";
  }
};

/// The spacing of Real at x.
template <class Real>
double ulp_at(oracle::Exact x) {
  using Limits = std::numeric_limits<Real>;
  const double smallest = Limits::denorm_min();
  if (x == 0) return smallest;
  return std::max(smallest,
                  std::ldexp(1.0, std::ilogb(static_cast<double>(x)) + 1 - Limits::digits));
}

/// Error of `actual`, in units in the last place of `scale`.
template <class Real>
double ulps(Real actual, oracle::Exact expected, oracle::Exact scale) {
  return static_cast<double>(exact::abs(oracle::Exact(actual) - expected)) / ulp_at<Real>(scale);
}

/// The largest error of the three components, in ULP of the force's magnitude.
template <class Precision>
double force_ulps(const ForceOf<Precision>& actual, const oracle::Force& expected) {
  using Real = RealOf<Precision>;
  const oracle::Exact scale = oracle::magnitude(expected);
  return std::max({ulps<Real>(actual.shear_x, expected.shear_x, scale),
                   ulps<Real>(actual.shear_y, expected.shear_y, scale),
                   ulps<Real>(actual.normal, expected.normal, scale)});
}

template <class Force>
oracle::Force to_exact(const Force& force) {
  return {force.shear_x, force.shear_y, force.normal};
}

}  // namespace pillarfield
